// From a scene to a canvas: by WebGL, or where there is none, triangle by triangle.
const EYE = 6;
const REACH = 1.3;

// The camera of a cell. `place` is its projection, for what is written over the picture.
function cameraOf(azimuth, height, cell) {
  const [a, h] = [(azimuth * Math.PI) / 180, (height * Math.PI) / 180];
  const to = [Math.cos(h) * Math.cos(a), Math.cos(h) * Math.sin(a), Math.sin(h)];
  const right = [-Math.sin(a), Math.cos(a), 0], up = cross(to, right), scale = cell.width / (2 * REACH);
  const place = (p) => {
    const near = (EYE / (EYE - dot(p, to))) * scale;
    return [cell.x + cell.width / 2 + near * dot(p, right), cell.y + cell.height / 2 - near * dot(p, up)];
  };
  const light = unit(plus(plus(times(right, -0.45), times(up, 0.75)), times(to, 0.6)));
  return { to, light, place, eye: times(to, EYE) };
}

// In software, samples within a pixel take most of the time: there they are for a still picture.
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;
let webgl = null, software = false;
const clock = { runs: false };
// How finely round things are drawn. Software takes a triangle as long as a hundred pixels, so
// that small bodies have few; without WebGL all have.
const coarse = { sides: 16, tube: 3, ring: 24 }, fine = { sides: 48, tube: 6, ring: 64 };
const detail = { ...coarse };
const refine = (small) => Object.assign(detail, webgl && !small ? fine : coarse);
function startWebgl() {
  const canvas = document.createElement("canvas"), test = canvas.getContext("webgl2");
  if (!test) return;
  software = SOFTWARE.test(test.getParameter(test.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? test.RENDERER));
  test.getExtension("WEBGL_lose_context")?.loseContext();
  webgl = new THREE.WebGLRenderer({ antialias: !software, alpha: true });
  refine(false);
  // The graphics driver may take it back at any time.
  webgl.domElement.addEventListener("webglcontextlost", () => { webgl = null; noteWebgl(); render(); });
}
const noteWebgl = () => { element("view-plain").hidden = webgl !== null; };

// Scenes in cells of a canvas so wide and high, all at once: one copy from WebGL costs as four.
function paintScenes(context, width, height, jobs, alpha = 1) {
  context.globalAlpha = alpha;
  if (webgl) {
    const screen = devicePixelRatio || 1, dots = software && !clock.runs && screen < 2 ? 2 * screen : screen, size = webgl.getSize(new THREE.Vector2());
    if (webgl.getPixelRatio() !== dots) webgl.setPixelRatio(dots);
    if (size.x !== width || size.y !== height) webgl.setSize(width, height, false);
    webgl.setScissorTest(false);
    webgl.clear();
    webgl.setScissorTest(true);
    for (const { cell, camera, scene: { scene, sun } } of jobs) {
      const lens = new THREE.PerspectiveCamera((360 / Math.PI) * Math.atan(REACH / EYE), 1, EYE / 4, 2 * EYE);
      const place = [cell.x, height - cell.y - cell.height, cell.width, cell.height];
      lens.up.set(0, 0, 1);
      lens.position.set(...camera.eye);
      lens.lookAt(0, 0, 0);
      sun.position.set(...camera.light);
      webgl.setViewport(...place);
      webgl.setScissor(...place);
      webgl.render(scene, lens);
    }
    context.drawImage(webgl.domElement, 0, 0, width, height);
  } else for (const { camera, scene } of jobs) paintTriangles(context, camera, scene.scene);
  context.globalAlpha = 1;
}

// The farthest first, flatly shaded: right to about a triangle's size.
function paintTriangles(context, camera, scene) {
  scene.updateMatrixWorld();
  const found = [], corner = new THREE.Vector3();
  scene.traverseVisible((mesh) => {
    if (!mesh.isMesh || mesh.material.transparent) return;
    const { geometry: { index, drawRange, attributes: { position, color } }, material, matrixWorld } = mesh;
    const count = Math.min(index ? index.count : position.count, drawRange.count);
    for (let k = 0; k < count; k += 3) {
      const numbers = [k, k + 1, k + 2].map((j) => (index ? index.getX(j) : j));
      const [a, b, c] = numbers.map((j) => corner.fromBufferAttribute(position, j).applyMatrix4(matrixWorld).toArray());
      const facing = unit(cross(plus(b, times(a, -1)), plus(c, times(a, -1))));
      if (dot(facing, plus(camera.eye, times(a, -1))) <= 0) continue;
      const own = color ? [color.getX(numbers[0]), color.getY(numbers[0]), color.getZ(numbers[0])] : material.color.toArray();
      const brightness = material.isMeshBasicMaterial ? 1 : 0.5 + 0.62 * Math.max(0, dot(facing, camera.light));
      found.push({ corners: [a, b, c], far: dot(plus(plus(a, b), c), camera.to), style: `rgb(${own.map((part) => Math.round(255 * Math.min(1, part * brightness))).join(" ")})` });
    }
  });
  context.lineJoin = "round";
  context.lineWidth = 0.8;
  for (const { corners, style } of found.sort((one, other) => one.far - other.far)) {
    path(context, corners.map(camera.place), true);
    context.fillStyle = context.strokeStyle = style;
    context.fill();
    context.stroke();
  }
}

function path(context, points, closed) {
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  if (closed) context.closePath();
}
