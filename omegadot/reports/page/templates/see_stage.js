// What the stage shows at a moment: a cell for each course, or one for all, and the polhode.
function cellsOf(width, count) {
  const rows = width < 560 ? Math.ceil(count / 2) : 1, columns = Math.min(count, width < 560 ? 2 : count);
  const side = Math.min(width / columns, 400), pad = (width - columns * side) / 2;
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
function title(context, cell, text, colour, look, below = "") {
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  [[text, `600 13px ${look.sans}`, 17, colour], [below, `12px ${look.sans}`, 33, look.ink]].forEach(([words, font, y, ink]) => {
    [context.font, context.fillStyle] = [font, ink];
    context.fillText(fitted(context, words, cell.width - 12), cell.x + cell.width / 2, cell.y + y);
  });
}
// From the moment a run parts its cell has a frame, a broad one at first.
function frame(context, cell, course, colour, time) {
  if (course.parts === null || time < course.parts) return;
  context.strokeStyle = colour;
  context.lineWidth = time - course.parts < course.time.at(-1) / 12 ? 4 : 1.5;
  context.strokeRect(cell.x + 3, cell.y + 3, cell.width - 6, cell.height - 6);
}

function paintStage(canvas, show, look) {
  const { shown, options } = show, width = show.widths.stage;
  const count = (options.overlaid ? 1 : shown.length) + (options.polhode ? 1 : 0);
  const { height, cells } = cellsOf(width, count), context = sized(canvas, width, height, look.panel);
  const bodies = options.overlaid ? [shown] : shown.map((one) => [one]);
  bodies.forEach((together, k) => paintCell(context, cells[k], together, show, look));
  if (!options.polhode) return;
  const cell = cells[count - 1];
  title(context, cell, "polhode", look.soft, look, "ω on the inertia ellipsoid");
  const camera = cameraOf(show.azimuth, show.tilt, inner(cell));
  paintPolhode(context, camera, show.scenario.ball, shown.map((one) => ({ ...one, width: one.course.line < 0 ? 2 : 1.3 })), show.time, look);
}
const inner = (cell) => ({ ...cell, y: cell.y + TITLE, height: cell.height - TITLE });

function paintCell(context, cell, together, show, look) {
  const { scenario, options, time } = show, camera = cameraOf(show.azimuth, show.tilt, inner(cell));
  const [first] = together;
  floor(context, camera, look.rule, scenario.pivot);
  for (const { course, colour } of together) {
    const { q, w } = poseAt(course, time);
    const trace = options.trace ? traceOf(course, scenario.tip, time) : [];
    const behind = (p) => dot(p, camera.to) < 0;
    const arrows = options.vectors(q, w).map(([vector, ...rest]) => [vector, ...rest, behind(vector)]);
    context.font = `600 12px ${look.sans}`;
    context.textBaseline = "middle";
    const half = (back) => {
      thread(context, camera, trace, colour, 1.5, (p) => behind(p) !== back, back ? 0 : 0.25);
      for (const [vector, label, dashed, away] of arrows) if (away === back) arrow(context, camera, vector, label, together.length > 1 ? colour : look.ink, dashed);
    };
    half(true);
    if (together.length > 1) ghost(context, cell, (own) => paintBody(own, camera, q, scenario.body, colour, look.mark));
    else paintBody(context, camera, q, scenario.body, colour, look.mark);
    half(false);
  }
  if (scenario.pivot) dotAt(context, camera.place([0, 0, 0]), 4, look.panel, look.ink);
  if (together.length > 1) title(context, cell, "overlaid", look.soft, look, "bodies that agree cover each other");
  else {
    title(context, cell, first.course.name, first.colour, look, first.state);
    frame(context, cell, first.course, first.colour, time);
  }
}

// A whole body half seen through: painted aside, then laid over.
function ghost(context, cell, paint) {
  ghost.canvas ??= document.createElement("canvas");
  const dots = devicePixelRatio || 1, aside = ghost.canvas;
  [aside.width, aside.height] = [context.canvas.width, context.canvas.height];
  const own = aside.getContext("2d");
  own.setTransform(dots, 0, 0, dots, 0, 0);
  paint(own);
  context.globalAlpha = 0.6;
  context.drawImage(aside, 0, 0, aside.width / dots, aside.height / dots);
  context.globalAlpha = 1;
}

// Where the body's tip has been in the last sixth of the run.
function traceOf(course, tip, time) {
  const points = 72, span = course.time.at(-1) / 6, from = Math.max(0, time - span);
  return Array.from({ length: points + 1 }, (_, k) => rotate(poseAt(course, from + ((time - from) * k) / points).q, tip));
}

// The attitude errors over time, under the time's own bar, with a flag where each run parts.
function paintErrors(canvas, show, look) {
  const width = show.widths.errors, height = 84, context = sized(canvas, width, height, look.panel);
  const left = 8, right = width - 8, base = height - 6, top = 16;
  const end = show.scenario.times.at(-1), most = Math.max(2, ...show.shown.map((one) => one.course.largest));
  const x = (time) => left + (time / end) * (right - left), y = (degrees) => base - (Math.min(degrees, most) / most) * (base - top);
  context.font = `11px ${look.sans}`;
  context.lineWidth = 1;
  context.strokeStyle = look.rule;
  path(context, [[left, base], [right, base]]);
  context.stroke();
  show.shown.filter((one) => one.course.error).forEach(({ course, colour }, k) => {
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = 3.2 - k;
    path(context, course.time.map((t, i) => [x(t), y(course.error[i])]));
    context.stroke();
    if (course.parts === null) return;
    context.lineWidth = 1.5;
    path(context, [[x(course.parts), base], [x(course.parts), top - 8]]);
    context.stroke();
    path(context, [[x(course.parts), top - 12], [x(course.parts) + 9, top - 8], [x(course.parts), top - 3]], true);
    context.fill();
  });
  context.fillStyle = look.soft;
  context.textBaseline = "alphabetic";
  const moments = [...new Set(show.shown.map((one) => one.course.parts).filter((time) => time !== null))];
  moments.sort((a, b) => a - b).forEach((time, k) => {
    const early = x(time) < (left + right) / 2;
    context.textAlign = early ? "left" : "right";
    context.fillText(`parts at ${seconds(time)}`, x(time) + (early ? 13 : -5), 12 + 13 * k);
  });
  context.textAlign = "right";
  context.fillText(`attitude error, to ${most < 10 ? most.toPrecision(2) : Math.round(most)}°`, right, 11);
  context.strokeStyle = look.ink;
  context.lineWidth = 1.5;
  path(context, [[x(show.time), height], [x(show.time), top - 12]]);
  context.stroke();
}
