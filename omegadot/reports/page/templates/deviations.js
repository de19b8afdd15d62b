// The error along the run: one line a run, and its round-off bound.
function deviationTraces({ data, codes }, scenario, place) {
  const axis = scenario.charts[place];
  return runsShown(scenario, place).map((group) => {
    const [line, , clock, starts, count] = group[0], look = data.lines[line], from = starts[place], own = ownColour(look.colour);
    const ownCodes = codes.subarray(from, from + count);
    return {
      type: "scatter", mode: count > 1 ? "lines" : "markers", name: briefOf(group, data), meta: { lines: group.map((run) => run[0]), group: group.map((run) => run[6]) },
      x: data.times[clock], y: Array.from(ownCodes, (code) => value(code, data)),
      text: Array.from(ownCodes, (code) => {
        const error = value(code, data);
        return code === 0 ? `at or below 1e${data.floor}` : error === null ? "" : written(error, 3) + unitText(axis.unit);
      }),
      hovertemplate: "%{fullData.name}<br>%{x} s: %{text}<extra></extra>",
      line: { color: own, width: look.width, dash: dashOf(look) },
      marker: { color: own },
    };
  });
}

// The bounds of the runs shown, from the smallest to the largest: a staircase, each stair up to the
// fraction of the run that it holds for.
function boundTraces({ data }, scenario, place) {
  const known = shownAt(scenario).filter((c) => c[5][place].length);
  if (!known.length) return [];
  const end = Math.max(...known.map((c) => data.times[c[2]].at(-1)));
  const bounds = known.map((c) => c[5][place]);
  const parts = [...new Set(bounds.flatMap((own) => own.filter((_, k) => k % 2 === 0)))].sort((a, b) => a - b);
  const at = (own, part) => own[own.findIndex((p, k) => k % 2 === 0 && p >= part) + 1];
  const stairs = (pick) => parts.flatMap((part) => {
    const level = pick(...bounds.map((own) => at(own, part)).filter((b) => b !== undefined && Number.isFinite(b)));
    return [level, level];
  });
  const x = parts.flatMap((part, k) => [k ? parts[k - 1] * end : 0, part * end]);
  const common = {
    type: "scatter", mode: "lines", hoverinfo: "skip", x, line: { color: colour("--soft"), width: 1, dash: "dash" },
  };
  const low = stairs(Math.min), high = stairs(Math.max);
  const lines = [{ ...common, name: "round-off bound", y: high }];
  if (low.some((level, k) => level < 0.98 * high[k])) {
    lines.unshift({ ...common, name: "round-off bound, smallest", y: low });
    Object.assign(lines[1], { fill: "tonexty", fillcolor: colour("--veil") });
  }
  return lines;
}

function deviationLayout(scenario, place, data, bounds) {
  const found = layout(scenario.charts[place], data);
  found.xaxis.range = [0, Math.max(...scenario.deviations.map((c) => data.times[c[2]].at(-1)))];
  if (bounds.length) found.annotations.push(levelName(bounds.at(-1).y[0], "round-off bound", "left", "bottom"));
  return found;
}
