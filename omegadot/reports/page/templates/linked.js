// The charts of a scenario act together: one zoom in time, one time under the pointer, one way back.
let linking = 0;
const timeCharts = (section) => section.charts.filter((chart) => !chart.dataset.kind && chart.data);

// Do something to charts without their answers coming back here.
async function quietly(action) {
  linking++;
  try { await action(); } finally { linking--; }
}

// Plotly's own hover, without its event: that would go round among the charts for ever.
const hoverAt = (chart, curveNumber, pointNumber) => Plotly.Fx.hover(chart, [{ curveNumber, pointNumber }], "xy", true);

function keepZoom(section, chart, change) {
  const low = change["xaxis.range[0]"] ?? change["xaxis.range"]?.[0], high = change["xaxis.range[1]"] ?? change["xaxis.range"]?.[1];
  const bottom = change["yaxis.range[0]"], top = change["yaxis.range[1]"];
  if (bottom !== undefined) chart.zoomed = [bottom, top];
  if (low === undefined || chart.dataset.kind) {
    if (low !== undefined) chart.zoomedAcross = [low, high];
    return;
  }
  section.range = [low, high];
  quietly(() => Promise.all(timeCharts(section).filter((c) => c !== chart)
    .map((other) => Plotly.relayout(other, { "xaxis.range": [low, high] }))));
}

// A drawn chart keeps what it was zoomed to until a double-click.
function zoomedLayout(section, chart, found) {
  const across = chart.dataset.kind ? chart.zoomedAcross : section.range;
  if (across) found.xaxis.range = [...across];
  if (chart.zoomed) found.yaxis.range = [...chart.zoomed];
  return found;
}

function resetZoom(section, chart) {
  const charts = chart.dataset.kind ? [chart] : timeCharts(section);
  if (!chart.dataset.kind) section.range = null;
  for (const one of charts) one.zoomed = one.zoomedAcross = null;
  want(charts);
}

function ruleOf(chart) {
  chart.rule ??= chart.parentNode.appendChild(made("div", { className: "now" }));
  return chart.rule;
}

function showTime(section, time) {
  for (const chart of timeCharts(section)) {
    const rule = ruleOf(chart), axis = chart._fullLayout?.xaxis;
    const [low, high] = axis?.range ?? [0, 0];
    rule.hidden = time === null || !(time >= low && time <= high);
    if (rule.hidden) continue;
    const plot = chart._fullLayout._size;
    rule.style.left = `${chart.offsetLeft + plot.l + ((time - low) / (high - low)) * plot.w}px`;
    rule.style.top = `${chart.offsetTop + plot.t}px`;
    rule.style.height = `${plot.h}px`;
    rule.dataset.time = written(time, 4);
  }
}

function timeUnder(chart, event) {
  const axis = chart._fullLayout?.xaxis, plot = chart._fullLayout?._size;
  if (!axis || !plot) return null;
  const part = (event.clientX - chart.getBoundingClientRect().left - plot.l) / plot.w;
  return part < 0 || part > 1 ? null : axis.range[0] + part * (axis.range[1] - axis.range[0]);
}

// The same run at the same sample in every chart of the scenario.
function hoverEverywhere(section, chart, point) {
  const line = point.data.meta?.lines?.[0];
  if (line === undefined || chart.dataset.kind) return;
  showTime(section, point.x);
  for (const other of timeCharts(section).filter((c) => c !== chart)) {
    const curve = other.data.findIndex((trace) => trace.meta?.lines?.includes(line));
    if (curve >= 0 && other.data[curve].y[point.pointNumber] !== null) hoverAt(other, curve, point.pointNumber);
    else Plotly.Fx.unhover(other);
  }
}

function leave(section) {
  showTime(section, null);
  for (const chart of timeCharts(section)) Plotly.Fx.unhover(chart);
}

const pointText = (chart, trace, k) => {
  const text = trace.text[k].replaceAll("<br>", ", ");
  return chart.dataset.kind === "equation" ? `${trace.y[k]}, ${trace.name}: ${text}`
    : chart.dataset.kind ? `${trace.name}, ${text}` : `${trace.name} at ${trace.x[k]} s: ${text}`;
};

async function pointCard(section, chart, trace, k) {
  const { sources, group } = trace.meta ?? {}, numbers = sources ? [sources[k]] : group;
  if (!numbers) return;
  const origins = await loadOrigins(), title = chart.closest("figure").querySelector("b").textContent;
  openCard(origins, numbers.map((n) => nameOf(sourceOf(origins, n))).join(" = "), section.node.id, numbers.map((n) => [`(${title})`, pointText(chart, trace, k), n]));
}

// Arrow keys walk: along a line, and from line to line. Enter opens the card of the point.
function walk(section, chart, event) {
  const lines = chart.data.map((trace, k) => [trace, k]).filter(([trace]) => trace.meta);
  const moves = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0], Home: [0, -1e9], End: [0, 1e9] };
  if (!lines.length || !(event.key in moves || event.key === "Enter" || event.key === " ")) return;
  event.preventDefault();
  const at = (chart.at ??= { line: 0, point: -1 }), [dLine, dPoint] = moves[event.key] ?? [0, 0];
  at.line = Math.min(lines.length - 1, Math.max(0, Math.min(at.line, lines.length - 1) + dLine));
  const [trace, curve] = lines[at.line];
  at.point = Math.min(trace.x.length - 1, Math.max(0, at.point + dPoint));
  while (trace.y[at.point] === null && at.point < trace.x.length - 1) at.point++;
  if (event.key === "Enter" || event.key === " ") pointCard(section, chart, trace, at.point);
  else {
    hoverAt(chart, curve, at.point);
    hoverEverywhere(section, chart, { data: trace, x: trace.x[at.point], pointNumber: at.point });
    element("announcement").textContent = pointText(chart, trace, at.point);
  }
}

function link(section, chart) {
  if (chart.linked) return;
  chart.linked = true;
  chart.tabIndex = 0;
  chart.setAttribute("role", "application");
  chart.setAttribute("aria-roledescription", "chart");
  chart.setAttribute("aria-label", `${chart.getAttribute("aria-label")} Arrow keys walk over its points, Enter shows the source of one.`);
  chart.on("plotly_relayout", (change) => { if (!linking) keepZoom(section, chart, change); });
  chart.on("plotly_doubleclick", () => resetZoom(section, chart));
  chart.on("plotly_click", ({ points: [point] }) => pointCard(section, chart, point.data, point.pointNumber));
  chart.on("plotly_hover", ({ points: [point] }) => hoverEverywhere(section, chart, point));
  chart.addEventListener("mousemove", (event) => { if (!chart.dataset.kind) showTime(section, timeUnder(chart, event)); });
  chart.addEventListener("mouseleave", () => leave(section));
  chart.addEventListener("blur", () => leave(section));
  chart.addEventListener("keydown", (event) => walk(section, chart, event));
}
