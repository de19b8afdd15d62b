// The solids of a body as one geometry over its reach. Some triangles are marked, so that an
// attitude can be seen to differ from the one turned half around.
// Multiples of four, so that marks end where triangles do.
const sidesFor = (count) => Math.min(detail.sides, count > 40 ? 12 : count > 8 ? 24 : 48);
const quarter = Math.PI / 2;
const geometries = {
  box: (sides, ...size) => new THREE.BoxGeometry(...size),
  cylinder: (sides, radius, length) => new THREE.CylinderGeometry(radius, radius, length, sides).rotateX(quarter),
  capsule: (sides, radius, length) => new THREE.CapsuleGeometry(radius, length, sides / 4, sides).rotateX(quarter),
  ellipsoid: (sides, ...axes) => new THREE.SphereGeometry(1, sides, sides / 2).rotateX(quarter).scale(...axes),
};
const inStripe = ([x, y]) => Math.abs(Math.atan2(y, x)) < Math.PI / 6;
const isMarked = {
  box: (middle, [x, y, z]) => x + y + z > 0,
  cylinder: (middle, [, , z]) => (Math.abs(z) > 0.9 ? middle[1] > 0 : inStripe(middle)),
  capsule: inStripe,
  ellipsoid: ([x, y, z]) => x * y * z > 0,
};

const triples = ({ array }) => Array.from({ length: array.length / 3 }, (_, k) => [...array.subarray(3 * k, 3 * k + 3)]);
// body: a list of [shape, size, position, orientation]. Three corners a triangle, none shared.
function geometryOf(body) {
  const corners = [], normals = [], marked = [];
  for (const [shape, size, position, [w, x, y, z]] of body) {
    const own = geometries[shape](sidesFor(body.length), ...size).toNonIndexed();
    const places = triples(own.attributes.position), facing = triples(own.attributes.normal);
    for (let k = 0; k < places.length; k += 3) {
      const middle = times(plus(plus(places[k], places[k + 1]), places[k + 2]), 1 / 3);
      marked.push(isMarked[shape](middle, facing[k]));
    }
    own.applyQuaternion(new THREE.Quaternion(x, y, z, w).normalize()).translate(...position);
    corners.push(...triples(own.attributes.position));
    normals.push(...triples(own.attributes.normal));
  }
  const reach = corners.reduce((most, corner) => Math.max(most, Math.hypot(...corner)), 0);
  const attribute = (rows) => new THREE.Float32BufferAttribute(rows.flat(), 3);
  return { position: attribute(corners.map((c) => times(c, 1 / reach))), normal: attribute(normals), marked, reach };
}

// The same corners for every run; colours of its own.
function colouredGeometry({ position, normal, marked }, colour, mark) {
  const shade = (share) => new THREE.Color(colour).lerp(new THREE.Color(mark), share).toArray();
  const plain = shade(0.06), apart = shade(0.6), found = new THREE.BufferGeometry();
  const colours = marked.flatMap((is) => { const own = is ? apart : plain; return [...own, ...own, ...own]; });
  found.setAttribute("position", position);
  found.setAttribute("normal", normal);
  return found.setAttribute("color", new THREE.Float32BufferAttribute(colours, 3));
}
