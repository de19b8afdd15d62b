// Poinsot's ellipsoid in body axes, its columns in `ball`, and where each omega pierces it.
function paintPolhode(context, camera, ball, courses, time, look) {
  const axes = [0, 1, 2].map((k) => [ball[k], ball[3 + k], ball[6 + k]]);
  const onto = (u) => axes.reduce((sum, axis, k) => plus(sum, times(axis, u[k])), [0, 0, 0]);
  const back = (p) => axes.map((axis) => dot(axis, p) / dot(axis, axis));
  const circle = (one, two) => Array.from({ length: 65 }, (_, k) => onto(plus(times(one, Math.cos((k * Math.PI) / 32)), times(two, Math.sin((k * Math.PI) / 32)))));
  const hides = (p) => dot(back(p), back(camera.to)) < 0;
  const seen = unit(back(camera.to)), aside = unit(cross(seen, Math.abs(seen[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0]));
  path(context, circle(aside, cross(seen, aside)).map(camera.place), true);
  context.fillStyle = look.shade;
  context.strokeStyle = look.rule;
  context.lineWidth = 1.2;
  context.fill();
  context.stroke();
  const [x, y, z] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (const [one, two] of [[x, y], [y, z], [z, x]]) thread(context, camera, circle(one, two), look.rule, 1, hides);
  context.fillStyle = look.soft;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `12px ${look.sans}`;
  axes.forEach((axis, k) => [1, -1].forEach((side) => {
    const end = times(axis, side);
    if (!hides(end)) context.fillText(["I₁", "I₂", "I₃"][k], ...camera.place(times(end, 1 + 0.12 / Math.hypot(...axis))));
  }));
  const pierced = (w) => times(w, 1 / (Math.hypot(...back(w)) || 1));
  for (const { course, colour, width } of courses) {
    const samples = course.w.filter((_, i) => course.line < 0 || course.time[i] <= time);
    thread(context, camera, samples.map(pierced), colour, width, hides);
  }
  for (const { course, colour } of courses) {
    const point = pierced(poseAt(course, time).w);
    context.globalAlpha = hides(point) ? 0.4 : 1;
    dotAt(context, camera.place(point), 4.5, colour, look.panel);
    context.globalAlpha = 1;
  }
}
