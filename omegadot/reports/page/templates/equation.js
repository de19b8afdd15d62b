// Omega-dot at identical states: one row an engine, its residuals and the bound. A residual of
// exactly zero has no place on a logarithmic axis; it is drawn apart, left of the axis.
function equationScale(rows) {
  const sizes = rows.flatMap((row) => row.slice(4)).filter((v) => v > 0).map(Math.log10);
  const low = Math.floor(Math.min(...sizes, -16)), high = Math.ceil(Math.max(...sizes, -13));
  const zero = rows.some((row) => row[4] === 0 || row[6] === 0);
  return { low, high, zero, lane: low - 0.6 };
}

// An engine goes when lines are selected and none of its own is.
function engineShown(name, data) {
  if (selection?.value !== "selected") return true;
  const own = data.lines.map((look, k) => (look.engine === name ? k : -1)).filter((k) => k >= 0);
  return !own.length || own.some((line) => !hidden.has(line));
}

function equationTraces({ data }, scenario) {
  const { lane } = equationScale(scenario.equation);
  const rows = scenario.equation.filter((row) => engineShown(row[0], data)).reverse();
  const kinds = [["random states", 4, "circle", 10], ["along the exact trajectory", 6, "diamond-open", 11]];
  const points = kinds.map(([name, place, symbol, size]) => {
    const own = rows.filter((row) => row[place] !== null), colours = own.map((row) => ownColour(row[2]));
    return {
      type: "scatter", mode: "markers", name, cliponaxis: false, meta: { sources: own.map((row) => row[3]) },
      y: own.map((row) => row[1]), x: own.map((row) => row[place] || 10 ** lane),
      text: own.map((row) => `${row[place] ? written(row[place], 3) : "exactly 0"}, bound ${row[place + 1] ? written(row[place + 1], 2) : "unknown"}`),
      hovertemplate: `%{y}, ${name}<br>%{text}<extra></extra>`,
      marker: { symbol, size, color: colours, line: { width: 2, color: colours } },
    };
  });
  const bounded = rows.filter((row) => row[5] > 0);
  const bounds = {
    type: "scatter", mode: "markers", name: "bound", hoverinfo: "skip", x: bounded.map((row) => row[5]), y: bounded.map((row) => row[1]),
    marker: { symbol: "line-ns-open", size: 26, color: colour("--ink"), line: { width: 2, color: colour("--ink") } },
  };
  return [bounds, ...points];
}

function equationLayout(scenario, data) {
  const { low, high, zero, lane } = equationScale(scenario.equation);
  const found = layout({ low, high, floor: false }, data);
  const every = Math.max(1, Math.ceil((high - low) / 6));
  const decades = Array.from({ length: high - low + 1 }, (_, k) => low + k).filter((d) => (d - low) % every === 0);
  found.xaxis = {
    ...axisLook(), type: "log", range: [zero ? lane - 0.4 : low, high], title: { text: "residual, relative", standoff: 6 }, tickmode: "array",
    tickvals: [...(zero ? [10 ** lane] : []), ...decades.map((d) => 10 ** d)], ticktext: [...(zero ? ["0"] : []), ...decades.map((d) => `10<sup>${d}</sup>`)],
  };
  found.yaxis = { ...axisLook(), type: "category", automargin: true, showgrid: false, fixedrange: true };
  found.margin.l = 80;
  found.margin.r = 24; // half of the last label
  found.shapes = zero ? [{ type: "line", yref: "paper", y0: 0, y1: 1, x0: 10 ** (low - 0.2), x1: 10 ** (low - 0.2), line: { color: colour("--soft"), width: 1, dash: "dot" } }] : [];
  return found;
}
