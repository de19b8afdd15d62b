// A picture in canvas 2-D: convex solids painted from the back to the front, flatly shaded.
const EYE = 6;
const REACH = 1.2;
const GRAIN = 1e-4;

// The whole numbers of a shape as points, once.
function grown(tree) {
  if (!tree) return null;
  const triples = (flat) => Array.from({ length: flat.length / 3 }, (_, k) => times(flat.slice(3 * k, 3 * k + 3), GRAIN));
  const pieces = tree[0].map(([marked, facing, flat]) => {
    const corners = triples(flat), middle = times(corners.reduce(plus), 1 / corners.length);
    return { marked, facing: triples(facing)[0], corners, middle };
  });
  if (!Array.isArray(tree[1])) return { pieces, mixed: tree[1] };
  return { pieces, plane: tree[1].map((part) => part * GRAIN), behind: grown(tree[2]), before: grown(tree[3]) };
}
function walk(tree, eye, paint) {
  if (!tree) return;
  if (tree.plane) {
    const before = dot(tree.plane, eye) > tree.plane[3];
    walk(before ? tree.behind : tree.before, eye, paint);
    tree.pieces.forEach(paint);
    walk(before ? tree.before : tree.behind, eye, paint);
  } else if (tree.mixed) {
    const far = (piece) => Math.hypot(...plus(piece.middle, times(eye, -1)));
    [...tree.pieces].sort((a, b) => far(b) - far(a)).forEach(paint);
  } else tree.pieces.forEach(paint);
}

// From the world to a cell of the canvas: the world's z is up, the middle at the origin.
function cameraOf(azimuth, height, cell) {
  const [a, h] = [(azimuth * Math.PI) / 180, (height * Math.PI) / 180];
  const to = [Math.cos(h) * Math.cos(a), Math.cos(h) * Math.sin(a), Math.sin(h)];
  const right = [-Math.sin(a), Math.cos(a), 0], up = cross(to, right);
  const scale = Math.min(cell.width, cell.height) / (2 * REACH);
  const [x, y] = [cell.x + cell.width / 2, cell.y + cell.height / 2];
  const light = unit(plus(plus(times(right, -0.45), times(up, 0.75)), times(to, 0.6)));
  const place = (p) => {
    const near = EYE / (EYE - dot(p, to));
    return [x + scale * near * dot(p, right), y - scale * near * dot(p, up)];
  };
  return { to, right, up, light, place, eye: times(to, EYE), scale };
}

function path(context, points, closed) {
  context.beginPath();
  points.forEach(([x, y], k) => (k ? context.lineTo(x, y) : context.moveTo(x, y)));
  if (closed) context.closePath();
}
const channels = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
function mixed(hex, other, share, brightness = 1) {
  const [one, two] = [channels(hex), channels(other)];
  return `rgb(${one.map((c, k) => Math.round(Math.min(255, (c + (two[k] - c) * share) * brightness))).join(" ")})`;
}

function paintBody(context, camera, q, tree, colour, mark) {
  context.lineJoin = "round";
  context.lineWidth = 0.8;
  walk(tree, rotate(inverse(q), camera.eye), (piece) => {
    const facing = rotate(q, piece.facing), first = rotate(q, piece.corners[0]);
    if (dot(facing, plus(camera.eye, times(first, -1))) <= 0) return;
    path(context, piece.corners.map((corner) => camera.place(rotate(q, corner))), true);
    const brightness = 0.5 + 0.62 * Math.max(0, dot(facing, camera.light));
    context.fillStyle = context.strokeStyle = mixed(colour, mark, piece.marked ? 0.6 : 0.06, brightness);
    context.fill();
    context.stroke();
  });
}

// The label stands beyond the head, to one side for a whole arrow, to the other for a dashed one.
function arrow(context, camera, vector, label, colour, dashed) {
  const start = camera.place([0, 0, 0]), end = camera.place(vector);
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]], length = Math.hypot(dx, dy);
  context.strokeStyle = context.fillStyle = colour;
  context.lineWidth = 1.8;
  context.setLineDash(dashed ? [5, 3] : []);
  path(context, [start, end]);
  context.stroke();
  context.setLineDash([]);
  if (length < 6) return;
  const [ux, uy] = [dx / length, dy / length];
  path(context, [[end[0] + 5 * ux, end[1] + 5 * uy], [end[0] - 5 * ux - 4 * uy, end[1] - 5 * uy + 4 * ux], [end[0] - 5 * ux + 4 * uy, end[1] - 5 * uy - 4 * ux]], true);
  context.fill();
  const side = dashed ? -9 : 9;
  context.textAlign = "center";
  context.fillText(label, end[0] + 8 * ux - side * uy, end[1] + 8 * uy + side * ux);
}

// A line through points of the world, in two strokes: `faint` where `hides` says so, else plain.
function thread(context, camera, points, colour, width, hides, faint = 0.25) {
  const places = points.map(camera.place), hidden = points.map(hides);
  context.strokeStyle = colour;
  context.lineWidth = width;
  for (const [which, alpha] of [[true, faint], [false, 1]]) {
    if (!alpha) continue;
    context.globalAlpha = alpha;
    context.beginPath();
    for (let k = 1; k < places.length; k++) {
      if (hidden[k] !== which) continue;
      if (k === 1 || hidden[k - 1] !== which) context.moveTo(...places[k - 1]);
      context.lineTo(...places[k]);
    }
    context.stroke();
  }
  context.globalAlpha = 1;
}

function floor(context, camera, colour, pivot) {
  const ring = Array.from({ length: 49 }, (_, k) => [0.55 * Math.cos((k * Math.PI) / 24), 0.55 * Math.sin((k * Math.PI) / 24), -1]);
  context.strokeStyle = colour;
  context.lineWidth = 1;
  path(context, ring.map(camera.place), true);
  context.stroke();
  if (!pivot) return;
  context.lineWidth = 3;
  path(context, [camera.place([0, 0, -1]), camera.place([0, 0, 0])]);
  context.stroke();
}
function dotAt(context, [x, y], radius, colour, ring) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.strokeStyle = ring;
  context.lineWidth = 1.5;
  context.fill();
  context.stroke();
}
