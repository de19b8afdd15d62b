// All engines side by side: the run that stands for each, and its cell, which is text over the stage.
function entryAt(scenario, line, rank) {
  const own = scenario.runs.filter((entry) => entry[0] === line), most = Math.max(...own.map((entry) => entry[1]));
  return own.find((entry) => entry[1] === Math.min(rank, most)) ?? own[0];
}
// Of each engine the most or the least exact run at the step. The errors of attitude end at 180°: a
// run that ends early is less exact than any, and then one that never flips.
function everyEngine(scenario, lines, rank, least) {
  const found = new Map(), end = scenario.times.at(-1) * (1 - 1e-9), error = (entry) => (entry[8] < end ? 720 : entry[11] === "never" ? 360 : 0) + entry[7];
  for (const line of new Set(scenario.runs.map((entry) => entry[0]))) {
    const { engine } = lines[line];
    found.set(engine, [...(found.get(engine) ?? []), entryAt(scenario, line, rank)]);
  }
  return [...found.values()].map((own) => {
    const entry = own.reduce((best, one) => ((least ? error(one) > error(best) : error(one) < error(best)) ? one : best));
    return { entry, others: own.filter((one) => one !== entry && one[9]).map((one) => lines[one[0]].integrator) };
  });
}

// Flips so far, of as many as the exact motion has; whether late or early once the run has ended.
function flipsText({ flips, turns, end }, exactFlips, time) {
  if (!exactFlips.length || !flips) return "";
  if (turns === "never") return "never flips";
  const past = flips.filter((one) => one <= time).length, off = time >= end && (turns === "late" || turns === "early") ? `flips ${turns}: ` : "";
  const count = `${past} ${past > exactFlips.length ? "for" : "of"} ${exactFlips.length}`;
  return off ? off + count : `${count} flips`;
}

// others: integrators of the same engine of which a gate fails while the one shown passes.
function walled(trajectory, lines, turning, others = []) {
  const { gates, diverges, turns, knob, name } = trajectory, line = lines[trajectory.line], never = turns === "never";
  const accuracy = knob.startsWith("accuracy") ? knob.replace("accuracy", " at") : "", hidden = { ariaHidden: "true" };
  const swatch = made("i", { className: "bar", ...hidden }), number = made("span"), turned = made("span", { className: never ? "v-fail" : "" });
  const flag = diverges === null ? [] : [made("span", { className: "unseen", textContent: "diverged at " }), `⚑ ${seconds(diverges)}`];
  const names = [made("b", { textContent: line?.engine ?? "exact" }), " ", line ? line.integrator + accuracy : name.replace("exact, ", "")];
  const item = made("li", {}, swatch, made("span", { className: "head" }, ...names), " ");
  item.append(made("i", { className: "body", ...hidden }), number, " ", made("span", { className: "flag" }, ...flag), " ", ...(turning ? [turned] : []));
  const failed = gates ? `✗ fails: ${gates}` : others.length ? `✗ ${others.join(", ")} fails` : "";
  if (failed) item.append(" ", made("span", { className: "v-fail", textContent: failed }));
  item.classList.toggle("fails", Boolean(failed) || never);
  return { item, swatch, number, turned };
}

// Where the cells and their bodies lie on the stage; asked for once, as widths are.
function placeCells(show) {
  const from = element("view-stage").getBoundingClientRect(), place = (node) => {
    const { x, y, width, height } = node.getBoundingClientRect();
    return { x: Math.round(x - from.x), y: Math.round(y - from.y), width: Math.round(width), height: Math.ceil(height) };
  };
  show.height = Math.ceil(element("view-wall").getBoundingClientRect().height);
  for (const one of show.shown) {
    const body = place(one.item.querySelector(".body"));
    Object.assign(one, { cell: { ...body, height: body.width }, outer: place(one.item) });
  }
}

function paintWall(canvas, show, theme) {
  const context = sized(canvas, show.widths.stage, show.height, theme.panel);
  context.fillStyle = theme["fail-back"];
  for (const { outer, item } of show.shown) if (item.classList.contains("fails")) context.fillRect(outer.x, outer.y, outer.width, outer.height);
  const jobs = show.shown.map((one) => jobOf(one, one.cell, show, theme));
  paintScenes(context, show.widths.stage, show.height, jobs);
  for (const { camera } of show.scenario.pivot ? jobs : []) dotAt(context, camera.place([0, 0, 0]), 2, theme.panel, theme.ink);
  for (const [place, label, ink] of jobs[0].labels) write(context, theme, label, place, ink); // the exact one's alone
}

// All cells as one sentence, for who does not see them.
function wallText(show) {
  const others = show.shown.slice(1), within = others.filter((one) => errorOf(one.trajectory) <= loaded.data.diverged).length;
  const never = others.filter((one) => one.trajectory.turns === "never").map((one) => loaded.data.lines[one.trajectory.line].engine);
  return `${within} of ${others.length} engines within ${loaded.data.diverged}° of the exact attitude${never.length ? `; never flip: ${never.join(", ")}` : ""}`;
}
