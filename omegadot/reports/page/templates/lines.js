// Which lines the charts show: at first the best and the worst integrator of each engine.
const step = element("step"), selection = element("shown");
const hidden = new Set();
const isShown = (scenario, line) => ({ first: () => scenario.first.includes(line), all: () => true })[selection?.value]?.() ?? !hidden.has(line);

// The rank shown of a scenario: a scenario with fewer steps shows its coarsest.
const rankIn = (scenario) => Math.min(Number(step?.value ?? 0), scenario.steps.length - 1);

function grouped(entries, key) {
  const groups = new Map();
  for (const entry of entries) groups.set(key(entry), [...(groups.get(key(entry)) ?? []), entry]);
  return [...groups.values()];
}
const namesOf = (group, data) => group.map(([line]) => data.lines[line].name).join(" = ");
const briefOf = (group, data) => namesOf(group.slice(0, 3), data) + (group.length > 3 ? ` and ${group.length - 3} more` : "");

// The runs shown in a chart: those that coincide there are one line, with all their names.
const shownAt = (scenario) => scenario.deviations.filter((run) => run[1] === rankIn(scenario) && isShown(scenario, run[0])).sort((a, b) => a[0] - b[0]);
const runsShown = (scenario, place) => grouped(shownAt(scenario), (run) => run[7][place]);
function sweepsShown(scenario, kind) {
  const own = scenario.sweeps.lines.filter(([line]) => isShown(scenario, line)).sort((a, b) => a[0] - b[0]);
  return grouped(own, ([line, , leader]) => (kind === "cost" ? line : leader));
}

const swatchOf = (line) => document.querySelector(`.panel input[value="${line}"]`).parentNode.querySelector("svg").cloneNode(true);

// What is drawn, below its chart.
function nameLines(chart, { data }, scenario) {
  const list = chart.parentNode.querySelector(".legend"), { kind, place } = chart.dataset;
  const groups = kind ? sweepsShown(scenario, kind) : runsShown(scenario, Number(place));
  list?.replaceChildren(...groups.map((group) => made("li", {}, swatchOf(group[0][0]), namesOf(group, data))));
}

// The boxes show what is shown; one that is changed selects.
function settleBoxes(scenario) {
  for (const box of document.querySelectorAll(".panel .one")) box.checked = isShown(scenario, Number(box.value));
  for (const group of document.querySelectorAll("fieldset[data-engine]")) {
    const all = group.querySelector(".all"), boxes = [...group.querySelectorAll(".one")], on = boxes.filter((box) => box.checked).length;
    all.checked = on > 0;
    all.indeterminate = on > 0 && on < boxes.length;
  }
}

function select(changed) {
  if (changed.matches(".all")) for (const box of changed.closest("fieldset").querySelectorAll(".one")) box.checked = changed.checked;
  for (const box of document.querySelectorAll(".panel .one")) box.checked ? hidden.delete(Number(box.value)) : hidden.add(Number(box.value));
  selection.value = "selected";
}
