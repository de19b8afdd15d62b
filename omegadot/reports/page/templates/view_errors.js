// The attitude errors over time, under the time's own bar, with a flag where each run diverges.
const ERRORS = { height: 84, left: 8, top: 16 };
function paintErrors(canvas, show, theme) {
  const width = show.widths.errors, { height, left, top } = ERRORS, context = sized(canvas, width, height, theme.panel);
  // Drawn once: while the clock runs, the hand alone moves.
  context.drawImage((show.errors ??= errorLines(width, show, theme)), 0, 0, width, height);
  const x = left + (show.time / show.scenario.times.at(-1)) * (width - 2 * left);
  context.strokeStyle = theme.ink;
  context.lineWidth = 1.5;
  path(context, [[x, height], [x, top - 12]]);
  context.stroke();
}

function errorLines(width, show, theme) {
  const { height, left, top } = ERRORS, canvas = document.createElement("canvas"), context = sized(canvas, width, height, theme.panel);
  const right = width - left, base = height - 6;
  const end = show.scenario.times.at(-1), most = Math.max(2, ...show.shown.map((one) => one.trajectory.largest));
  const x = (time) => left + (time / end) * (right - left), y = (degrees) => base - (Math.min(degrees, most) / most) * (base - top);
  context.font = `11px ${theme.sans}`;
  context.lineWidth = 1;
  context.strokeStyle = theme.rule;
  path(context, [[left, base], [right, base]]);
  context.stroke();
  show.shown.filter((one) => one.trajectory.error).forEach(({ trajectory, colour }, k) => {
    context.strokeStyle = context.fillStyle = colour;
    context.lineWidth = show.all ? 1.2 : 3.2 - k;
    path(context, trajectory.time.map((t, i) => [x(t), y(trajectory.error[i])]));
    context.stroke();
    if (trajectory.diverges === null) return;
    context.lineWidth = 1.5;
    path(context, [[x(trajectory.diverges), base], [x(trajectory.diverges), top - 8]]);
    context.stroke();
    path(context, [[x(trajectory.diverges), top - 12], [x(trajectory.diverges) + 9, top - 8], [x(trajectory.diverges), top - 3]], true);
    context.fill();
  });
  context.fillStyle = theme.soft;
  context.textBaseline = "alphabetic";
  // Of many runs the flags alone: each cell states its time.
  const moments = show.all ? [] : [...new Set(show.shown.map((one) => one.trajectory.diverges).filter((time) => time !== null))];
  moments.sort((a, b) => a - b).forEach((time, k) => {
    const early = x(time) < (left + right) / 2;
    context.textAlign = early ? "left" : "right";
    context.fillText(`diverges at ${seconds(time)}`, x(time) + (early ? 13 : -5), 12 + 13 * k);
  });
  context.textAlign = "right";
  context.fillText(`attitude error, to ${written(most, most < 100 ? 2 : 3)}°`, right, 11);
  return canvas;
}
