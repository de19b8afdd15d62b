// What stands in a scene: a body, lines, arrows, lights. The world's z is up.
const vector = (a) => new THREE.Vector3(...a);

// A round line with a ring of corners at each point.
function tube(points, radius, closed = false) {
  const curve = new THREE.CatmullRomCurve3(points.map(vector), closed);
  [curve.getPointAt, curve.getTangentAt] = [curve.getPoint, curve.getTangent];
  return new THREE.TubeGeometry(curve, points.length - (closed ? 0 : 1), radius, detail.tube, closed);
}
const ring = (place) => Array.from({ length: detail.ring }, (_, k) => place(Math.cos((2 * k * Math.PI) / detail.ring), Math.sin((2 * k * Math.PI) / detail.ring)));

// In its colour where it is in sight, faint where a solid hides it.
function seenThrough(geometry, colour, faint = 0.25) {
  const behind = { transparent: true, opacity: faint, depthFunc: THREE.GreaterDepth, depthWrite: false };
  const group = new THREE.Group();
  for (const more of [{}, behind]) group.add(new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: colour, ...more })));
  return group;
}

// An arrow from the origin. A dashed one needs no colour to be distinguished.
const HEAD = 0.13;
function arrow(colour, dashed) {
  const group = new THREE.Group(), shaft = new THREE.Group(), pieces = dashed ? 7 : 1, length = (dashed ? 0.6 : 1) / pieces;
  const rod = new THREE.CylinderGeometry(0.014, 0.014, length, 12).rotateX(quarter);
  for (let k = 0; k < pieces; k++) {
    const piece = seenThrough(rod, colour, 0.45);
    piece.position.z = k / pieces + length / 2;
    shaft.add(piece);
  }
  const head = seenThrough(new THREE.ConeGeometry(0.042, HEAD, 20).rotateX(quarter), colour);
  group.add(shaft, head);
  const pointTo = (end) => {
    const long = Math.hypot(...end);
    group.visible = long > 0.01;
    group.quaternion.setFromUnitVectors(vector([0, 0, 1]), vector(unit(end)));
    shaft.scale.z = Math.max(1e-3, long - HEAD);
    head.position.z = Math.max(long - HEAD / 2, HEAD / 2);
  };
  return { group, pointTo };
}

function litScene() {
  const scene = new THREE.Scene(), sun = new THREE.DirectionalLight("#ffffff", 0.6), sky = new THREE.HemisphereLight("#ffffff", "#777780", 0.62);
  sky.position.set(0, 0, 1);
  scene.add(sky, sun);
  return { scene, sun };
}
const surface = (more) => new THREE.MeshPhongMaterial({ specular: "#202020", shininess: 30, ...more });

// A run's own scene: `set` brings it to a moment.
function sceneOf(scenario, colour, theme, arrowColour) {
  const { scene, sun } = litScene();
  const body = new THREE.Mesh(colouredGeometry(scenario.geometry, colour, theme.mark), surface({ vertexColors: true }));
  // No solid is seen through: a trace behind one would seem to be drawn on its face.
  const trace = new THREE.Mesh(new THREE.BufferGeometry(), new THREE.MeshBasicMaterial({ color: colour }));
  const arrows = { H: arrow(arrowColour, false), ω: arrow(arrowColour, true) };
  scene.add(body, trace, arrows.H.group, arrows.ω.group);
  scene.add(new THREE.Mesh(tube(ring((x, y) => [0.55 * x, 0.55 * y, -1]), 0.006, true), new THREE.MeshBasicMaterial({ color: theme.stand })));
  if (scenario.pivot) scene.add(new THREE.Mesh(tube([[0, 0, -1], [0, 0, -0.5], [0, 0, 0]], 0.016), new THREE.MeshBasicMaterial({ color: theme.stand })));
  const set = ({ q: [w, x, y, z], points, vectors }) => {
    body.quaternion.set(x, y, z, w);
    trace.visible = points.length > 0;
    if (points.length) {
      trace.geometry.dispose();
      trace.geometry = tube(points, 0.008);
    }
    for (const own of Object.values(arrows)) own.group.visible = false;
    for (const [end, label] of vectors) arrows[label].pointTo(end);
  };
  return { scene, sun, set };
}

function release({ scene }) {
  scene.traverse((one) => { one.geometry?.dispose(); one.material?.dispose(); });
}
