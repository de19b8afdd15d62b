// Charts are pictures at first. When the page comes to rest those in view become interactive, one
// after the other, so that scrolling is never held up.
let current = null; // the scenario shown: its node, its charts, the time that is zoomed to

function parts(section, chart, loaded, scenario) {
  const kind = chart.dataset.kind;
  if (kind === "equation") return [equationTraces(loaded, scenario), equationLayout(scenario, loaded.data)];
  if (kind) return [sweepTraces(loaded, scenario, kind), sweepLayout(scenario, loaded.data, kind)];
  const place = Number(chart.dataset.place), bounds = boundTraces(loaded, scenario, place);
  return [[...bounds, ...deviationTraces(loaded, scenario, place)], deviationLayout(scenario, place, loaded.data, bounds)];
}

async function draw(section, chart) {
  const loaded = await load(), scenario = loaded.data.scenarios[section.node.id];
  if (!chart.isConnected) return;
  if (!section.settled) settleBoxes(scenario);
  section.settled = true;
  const [traces, found] = parts(section, chart, loaded, scenario);
  chart.classList.add("live");
  nameLines(chart, loaded, scenario);
  await quietly(() => Plotly.react(chart, traces, zoomedLayout(section, chart, found), settings));
  link(section, chart);
  root.dataset.drawn = Number(root.dataset.drawn || 0) + 1;
}

let working = false;
const next = () => current?.charts.find((one) => one.near) ?? current?.charts.find((one) => one.wanted);
async function work() {
  if (working) return;
  working = true;
  try {
    for (let chart; (chart = next()); ) {
      await rest();
      if (chart !== next()) continue;
      chart.wanted = chart.near = false;
      await draw(current, chart);
    }
  } catch (error) {
    console.error(error);
    element("no-charts").hidden = false;
    element("no-charts").textContent = `The interactive charts cannot be drawn in this browser (${error.message}); the pictures show the finest step, and every number is in the tables.`;
  }
  working = false;
}

function want(charts) {
  for (const chart of charts) chart.wanted = true;
  work();
}

// What was only passed by is not drawn.
const nearby = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) target.near = isIntersecting && !target.data;
  work();
}, { rootMargin: "100px 0px" });

// Another step, other lines, other colours: all charts of the scenario follow.
async function redraw() {
  if (!current?.charts.length) return;
  const section = current, loaded = await load(), scenario = loaded.data.scenarios[section.node.id];
  for (const span of section.node.querySelectorAll(".at-step")) span.textContent = ` · ${scenario.steps[rankIn(scenario)]}`;
  settleBoxes(scenario);
  want(section.charts);
}
