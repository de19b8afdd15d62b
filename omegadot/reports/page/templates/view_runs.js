// Which runs the view shows, in its lists and in its table.
function allShown(scenario, rank) {
  const { lines } = loaded.data, chosen = everyEngine(scenario, lines, rank, element("view-which").value === "least");
  const runs = chosen.map(({ entry, others }) => [runTrajectory(loaded, scenario, exact, entry), others]);
  return [[exact], ...runs].map(([trajectory, others]) => ({ trajectory, ...walled(trajectory, lines, scenario.flips.length > 0, others) }));
}
function pickedShown(scenario, rank) {
  const lines = [...document.querySelectorAll(".view-engine")].map((select) => Number(select.value)).filter((line) => line >= 0);
  const trajectories = [...new Set(lines)].map((line) => runTrajectory(loaded, scenario, exact, entryAt(scenario, line, rank)));
  return [exact, ...trajectories].map((trajectory) => ({ trajectory, ...listed(trajectory) }));
}

function listed(trajectory) {
  const swatch = made("i", { ariaHidden: "true" }), number = made("span");
  const item = made("li", {}, swatch, made("b", { textContent: fullName(trajectory) }), " ", number);
  if (trajectory.gates) item.append(" ", made("span", { className: "v-fail", textContent: `fails: ${trajectory.gates}` }));
  const content = { textContent: trajectory.line < 0 ? "" : divergenceOf(trajectory) };
  const there = () => { if (show.playing) play(false); goTo(trajectory.diverges); announce(`${trajectory.name} ${divergenceOf(trajectory)}.`); };
  item.append(" ", trajectory.diverges === null ? made("span", content) : made("button", { ...content, type: "button", onclick: there }));
  return { item, swatch, number };
}

function offer(scenario) {
  const { lines } = loaded.data, there = [...new Set(scenario.runs.map((entry) => entry[0]))], first = scenario.first;
  document.querySelectorAll(".view-engine").forEach((select, k) => {
    const kept = picked.runs && (there.includes(Number(select.value)) || select.value === "-1") ? Number(select.value) : first[k] ?? -1;
    const option = (text, value) => new Option(text, value, false, value === kept);
    select.replaceChildren(option("none", -1), ...there.map((line) => option(lines[line].name, line)));
  });
}

function tabulate(scenario) {
  const heads = [...element("view-table").tHead.rows[0].cells].slice(1).map((cell) => cell.textContent);
  const rows = scenario.runs.map(([line, , knob, , , , diverges, largest, end, , flips, turns]) => {
    const turned = flipsText({ flips, turns, end }, scenario.flips, end) || "–";
    const cells = [knob, diverges === null ? "does not" : seconds(diverges), exactly(largest), seconds(end), turned];
    const head = made("th", { scope: "row", textContent: loaded.data.lines[line].name });
    const row = made("tr", {}, head, ...cells.map((text) => made("td", { textContent: text })));
    [...row.cells].slice(1).forEach((cell, k) => { cell.dataset.head = heads[k]; });
    return row;
  });
  element("view-table").tBodies[0].replaceChildren(...rows);
}
