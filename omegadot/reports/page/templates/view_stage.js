// What the stage shows at a moment: a cell for each trajectory, or one for all, and the polhode.
function cellsOf(width, count) {
  const rows = width < 560 ? Math.ceil(count / 2) : 1, columns = Math.min(count, width < 560 ? 2 : count);
  const side = Math.floor(Math.min(width / columns, 400)), pad = Math.floor((width - columns * side) / 2);
  return {
    height: Math.round(rows * (side + TITLE)),
    cells: Array.from({ length: count }, (_, k) => ({
      x: pad + (k % columns) * side, y: Math.floor(k / columns) * (side + TITLE), width: side, height: side + TITLE,
    })),
  };
}
const TITLE = 38;

// The canvas as large as its box, in the screen's own dots; its ground is kept on paper.
function sized(canvas, width, height, ground) {
  const dots = devicePixelRatio || 1, context = canvas.getContext("2d");
  const [w, h] = [Math.round(width * dots), Math.round(height * dots)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  if (canvas.style.height !== `${height}px`) canvas.style.height = `${height}px`;
  context.setTransform(dots, 0, 0, dots, 0, 0);
  context.fillStyle = ground;
  context.fillRect(0, 0, width, height);
  return context;
}

function fitted(context, text, width) {
  if (context.measureText(text).width <= width) return text;
  let kept = text.length;
  while (kept > 1 && context.measureText(`${text.slice(0, kept)}…`).width > width) kept--;
  return `${text.slice(0, kept)}…`;
}
function title(context, cell, text, colour, theme, below = "") {
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  context.font = `12px ${theme.sans}`;
  // No number is cut off: where a line is too long it goes on in the next.
  const lines = context.measureText(below).width > cell.width - 12 ? below.split(", ") : [below];
  const parts = lines.map((line, k) => [line, `12px ${theme.sans}`, 33 + 14 * k, theme.ink]);
  [[text, `600 13px ${theme.sans}`, 17, colour], ...parts].forEach(([line, font, y, ink]) => {
    [context.font, context.fillStyle] = [font, ink];
    context.fillText(fitted(context, line, cell.width - 12), cell.x + cell.width / 2, cell.y + y);
  });
}
// A run of which a gate fails has a frame, broad for a while where it diverges; no sound run has one.
function frame(context, cell, trajectory, colour, time) {
  if (!trajectory.gates) return;
  const since = trajectory.diverges === null ? -1 : time - trajectory.diverges;
  context.strokeStyle = colour;
  context.lineWidth = since >= 0 && since < trajectory.time.at(-1) / 12 ? 4 : 1.5;
  context.strokeRect(cell.x + 3, cell.y + 3, cell.width - 6, cell.height - 6);
}

function paintStage(canvas, show, theme) {
  if (show.all) return paintWall(canvas, show, theme);
  const { shown, options } = show, width = show.widths.stage;
  const count = (options.overlaid ? 1 : shown.length) + (options.polhode ? 1 : 0);
  const { height, cells } = cellsOf(width, count), context = sized(canvas, width, height, theme.panel);
  const together = options.overlaid ? [shown] : shown.map((one) => [one]);
  const jobs = together.flatMap((runs, k) => runs.map((one) => jobOf(one, inner(cells[k]), show, theme)));
  if (options.overlaid) for (const job of jobs) paintScenes(context, width, height, [job], 0.65);
  const polhode = options.polhode ? polhodeJob(cells[count - 1], show, theme) : null;
  const others = [...(options.overlaid ? [] : jobs), ...(polhode ? [polhode] : [])];
  if (others.length) paintScenes(context, width, height, others);
  for (const { labels } of [...jobs, ...(polhode ? [polhode] : [])]) {
    for (const [place, label, ink] of labels) write(context, theme, label, place, ink);
  }
  together.forEach((runs, k) => caption(context, cells[k], runs, show, theme));
  if (polhode) title(context, cells[count - 1], "polhode", theme.soft, theme, "ω on the inertia ellipsoid");
}
const inner = (cell) => ({ ...cell, y: cell.y + TITLE, height: cell.height - TITLE });
function write(context, theme, text, place, colour) {
  [context.font, context.fillStyle] = [`600 12px ${theme.sans}`, colour];
  [context.textAlign, context.textBaseline] = ["center", "middle"];
  context.fillText(text, ...place);
}

// A run at the clock's moment: its scene, and what is written where on the canvas.
function jobOf(one, cell, show, theme) {
  const { scenario, options, time } = show, { trajectory, colour } = one, { q, w } = poseAt(trajectory, time);
  const camera = cameraOf(show.azimuth, show.tilt, cell), ink = options.overlaid ? colour : theme.ink;
  const points = options.trace && time > 0 ? traceOf(trajectory, scenario.tipOverReach, time, show.all ? 24 : 72) : [], vectors = options.vectors(q, w);
  const scene = ((one.scenes ??= {})[ink] ??= sceneOf(scenario, colour, theme, ink));
  scene.set({ q, points, vectors });
  return { cell, camera, scene, labels: vectors.map(([end, label]) => [besideHead(camera, end, label === "H" ? 1 : -1), label, ink]) };
}
// Beyond an arrow's head and to one side of it, in the canvas.
function besideHead(camera, end, side) {
  const [[x, y], [u, v]] = [camera.place([0, 0, 0]), camera.place(end)], length = Math.hypot(u - x, v - y) || 1;
  const [dx, dy] = [(u - x) / length, (v - y) / length];
  return [u + 2 * dx + 13 * side * dy, v + 2 * dy - 13 * side * dx];
}
function polhodeJob(outer, show, theme) {
  const cell = inner(outer), camera = cameraOf(show.azimuth, show.tilt, cell), scene = (show.polhode ??= polhodeOf(show.scenario, show.shown, theme));
  scene.set(show.time);
  return { cell, camera, scene, labels: scene.ends(camera).map(([end, label]) => [camera.place(end), label, theme.ink]) };
}

function caption(context, cell, together, show, theme) {
  if (show.scenario.pivot) dotAt(context, cameraOf(show.azimuth, show.tilt, inner(cell)).place([0, 0, 0]), 4, theme.panel, theme.ink);
  if (show.options.overlaid) {
    title(context, cell, "overlaid", theme.soft, theme, "bodies that agree cover each other");
    return;
  }
  const [{ trajectory, colour, status }] = together;
  title(context, cell, trajectory.gates ? `✗ ${trajectory.name}` : trajectory.name, colour, theme, status ?? "");
  frame(context, cell, trajectory, colour, show.time);
}

// Colours or runs changed: the scenes are made again when they are next painted.
function clearScenes(show) {
  for (const one of show.shown) {
    Object.values(one.scenes ?? {}).forEach(release);
    one.scenes = null;
  }
  if (show.polhode) release(show.polhode);
  show.polhode = show.errors = null;
}

function dotAt(context, [x, y], radius, colour, rim) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  [context.fillStyle, context.strokeStyle, context.lineWidth] = [colour, rim, 1.5];
  context.fill();
  context.stroke();
}

// Where the body's tip has been in the last sixth of the run.
function traceOf(trajectory, tip, time, points) {
  const span = trajectory.time.at(-1) / 6, from = Math.max(0, time - span);
  return Array.from({ length: points + 1 }, (_, k) => rotate(poseAt(trajectory, from + ((time - from) * k) / points).q, tip));
}
