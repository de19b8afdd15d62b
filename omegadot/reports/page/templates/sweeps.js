// Error over the step and over the cost: one point a run, one line an integrator.
function sweepTraces({ data }, scenario, kind) {
  const sweeps = scenario.sweeps, over = kind === "cost" ? (point) => point[2] : (point) => point[0];
  const lines = sweepsShown(scenario, kind).map((group) => {
    const [line, all] = group[0], look = data.lines[line], points = all.filter((p) => over(p) && p[1] !== null), own = ownColour(look.colour);
    return {
      type: "scatter", mode: "lines+markers", name: briefOf(group, data), cliponaxis: false, meta: { lines: [line], sources: points.map((p) => p[3]) },
      x: points.map(over), y: points.map((p) => Math.max(p[1], 10 ** data.floor)),
      text: points.map((p) => `step ${written(p[0])} s: ${p[1] > 10 ** data.floor ? written(p[1], 3) : `at or below 1e${data.floor}`} rad`
        + (p[2] ? `<br>${written(p[2], 3)} s per simulated second` : "")),
      hovertemplate: "%{fullData.name}<br>%{text}<extra></extra>",
      line: { color: own, width: look.width, dash: dashOf(look) }, marker: { color: own, size: 5 + look.width },
    };
  });
  return [...(kind === "cost" ? frontTraces(scenario, data) : guideTraces(sweeps)), ...lines];
}

const grey = () => ({ type: "scatter", hoverinfo: "skip", textfont: { size: 11, color: colour("--soft") } });

function guideTraces(sweeps) {
  const guides = sweeps.guides.map(([order, h0, e0, h1, e1]) => ({
    ...grey(), mode: "lines+text", name: `order ${order}`, x: [h0, h1], y: [e0, e1], text: ["", `order ${order}`],
    textposition: "top left", line: { color: colour("--soft"), width: 1, dash: "dot" },
  }));
  const rounding = sweeps.rounding.length ? [{
    ...grey(), mode: "lines+text", name: "round-off bound", x: sweeps.rounding.map((p) => p[0]), y: sweeps.rounding.map((p) => p[1]),
    text: sweeps.rounding.map((_, i) => (i ? "" : "round-off bound")), textposition: "top right",
    line: { color: colour("--soft"), width: 1, dash: "dash" },
  }] : [];
  return [...guides, ...rounding];
}

// Stairs: at each cost the smallest error that can be had for it.
function frontTraces(scenario, data) {
  const points = scenario.front.map(([cost, error]) => [cost, Math.max(error, 10 ** data.floor)]);
  if (!points.length) return [];
  return [{
    ...grey(), mode: "lines", name: "Pareto front", x: points.map((p) => p[0]), y: points.map((p) => p[1]),
    line: { color: colour("--front"), width: 9, shape: "hv" },
  }];
}

function sweepLayout(scenario, data, kind) {
  const sweeps = scenario.sweeps, found = layout(sweeps, data);
  const values = sweeps.lines.flatMap(([, points]) => points.map((p) => (kind === "cost" ? p[2] : p[0]))).filter(Boolean);
  const bounds = kind === "cost" ? [] : sweeps.rounding.map((p) => Math.log10(p[1]));
  const ends = kind === "cost" ? [] : sweeps.guides.map((guide) => Math.log10(guide[4]));
  const bottom = Math.min(found.yaxis.range[0], ...bounds.map(Math.floor)), top = Math.max(...ends, -Infinity);
  // Above a guide there is room for its name.
  found.yaxis.range = [bottom, Math.max(found.yaxis.range[1], top + 0.1 * (top - bottom) || -Infinity)];
  const low = Math.log10(Math.min(...values)), high = Math.log10(Math.max(...values)), room = 0.08 * (high - low) + 0.04;
  Object.assign(found.xaxis, { type: "log", range: [low - room, high + room], exponentformat: "power" });
  found.xaxis.title.text = kind === "cost" ? "wall time per simulated second, s" : "time step, s";
  if (kind === "cost" && narrow.matches) found.xaxis.dtick = 1;
  if (kind === "convergence") {
    const steps = [...new Set(values)].sort((a, b) => a - b);
    Object.assign(found.xaxis, { tickmode: "array", tickvals: steps, ticktext: steps.map((step) => written(step)) });
  }
  return found;
}
