"use strict";
(() => {
  const root = document.documentElement;
  root.classList.add("js");
  const element = (id) => document.getElementById(id);
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const narrow = matchMedia("(max-width: 40rem)");
  const coarse = matchMedia("(pointer: coarse)");
  let printing = false;

  async function unpack(id) {
    const text = atob(element(id).textContent.trim());
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; i++) bytes[i] = text.charCodeAt(i);
    const gzip = new DecompressionStream("gzip"), writer = gzip.writable.getWriter();
    writer.write(bytes).then(() => writer.close());
    return new Response(gzip.readable);
  }

  // High bytes first, low bytes after, differences modulo 65536.
  function undifference(bytes) {
    const count = bytes.length / 2, codes = new Uint16Array(count);
    for (let i = 0, sum = 0; i < count; i++) codes[i] = sum += (bytes[i] << 8) | bytes[count + i];
    return codes;
  }

  let loading = null;
  function load() {
    loading ??= (async () => {
      const [script, description, codes] = await Promise.all([
        unpack("plotly-data").then((r) => r.text()),
        unpack("charts-data").then((r) => r.json()),
        unpack("codes-data").then((r) => r.arrayBuffer()),
      ]);
      const tag = document.createElement("script");
      tag.textContent = script;
      document.head.append(tag);
      return { data: description, codes: undifference(new Uint8Array(codes)) };
    })();
    return loading;
  }

  function value(code, data) {
    if (code === 65535) return null;
    if (code === 0) return 10 ** data.floor;
    return 10 ** (data.floor + ((code - 1) / 65533) * (data.ceiling - data.floor));
  }

  const hidden = new Set();
  const step = element("step");
  const unitText = (unit) => (unit === "1" ? "" : " " + unit);

  // The rank shown of a scenario: a scenario with fewer steps shows its coarsest.
  const rankIn = (scenario) => Math.min(Number(step.value), scenario.steps.length - 1);

  function traces({ data, codes }, scenario, place) {
    const rank = rankIn(scenario), axis = scenario.charts[place];
    const shown = scenario.courses.filter((c) => c[1] === rank && !hidden.has(c[0]));
    return shown.sort((a, b) => a[0] - b[0]).map(([line, , clock, start, count]) => {
      const look = data.lines[line], from = start + place * count;
      const course = codes.subarray(from, from + count);
      const own = look.colour[dark.matches && !printing ? 1 : 0];
      return {
        type: "scatter", mode: count > 1 ? "lines" : "markers", name: look.name,
        x: data.times[clock], y: Array.from(course, (code) => value(code, data)),
        text: Array.from(course, (code) => code === 0
          ? `at or below 1e${data.floor}` : value(code, data)?.toExponential(2) + unitText(axis.unit)),
        hovertemplate: "%{fullData.name}<br>%{x} s: %{text}<extra></extra>",
        line: { color: own, width: look.width, dash: dashOf(look) },
        marker: { color: own },
      };
    });
  }

  const style = getComputedStyle(root);
  const colour = (name) => style.getPropertyValue(name).trim();
  const dashOf = (look) => look.dash.replaceAll(" ", "px,") + (look.dash && "px") || "solid";

  // A sweep's points, one an own step: over the step, or over the cost.
  function sweepTraces({ data }, sweeps, kind) {
    const over = kind === "cost" ? (point) => point[2] : (point) => point[0];
    const shown = sweeps.lines.filter(([line]) => !hidden.has(line)).sort((a, b) => a[0] - b[0]);
    const lines = shown.map(([line, all]) => {
      const look = data.lines[line], points = all.filter((p) => over(p) && p[1] !== null);
      const own = look.colour[dark.matches && !printing ? 1 : 0];
      return {
        type: "scatter", mode: "lines+markers", name: look.name, cliponaxis: false,
        x: points.map(over), y: points.map((p) => Math.max(p[1], 10 ** data.floor)),
        text: points.map((p) => `step ${p[0]} s: ${p[1] > 10 ** data.floor ? p[1].toExponential(2) : `at or below 1e${data.floor}`} rad`
          + (p[2] ? `<br>${p[2].toExponential(2)} s per simulated second` : "")),
        hovertemplate: "%{fullData.name}<br>%{text}<extra></extra>",
        line: { color: own, width: look.width, dash: dashOf(look) }, marker: { color: own, size: 5 + look.width },
      };
    });
    if (kind === "cost") return lines;
    const grey = { type: "scatter", hoverinfo: "skip", textfont: { size: 11, color: colour("--soft") } };
    const guides = sweeps.guides.map(([order, h0, e0, h1, e1]) => ({
      ...grey, mode: "lines+text", name: `order ${order}`, x: [h0, h1], y: [e0, e1], text: ["", `order ${order}`],
      textposition: "top left", line: { color: colour("--soft"), width: 1, dash: "dot" },
    }));
    const rounding = sweeps.rounding.length ? [{
      ...grey, mode: "lines+text", name: "rounding", x: sweeps.rounding.map((p) => p[0]), y: sweeps.rounding.map((p) => p[1]),
      text: sweeps.rounding.map((_, i) => (i ? "" : "rounding, at most")), textposition: "top right",
      line: { color: colour("--soft"), width: 1, dash: "dash" },
    }] : [];
    return [...guides, ...rounding, ...lines];
  }

  function sweepLayout(sweeps, data, kind) {
    const found = layout(sweeps, data);
    const values = sweeps.lines.flatMap(([, points]) => points.map((p) => (kind === "cost" ? p[2] : p[0]))).filter(Boolean);
    const bounds = kind === "cost" ? [] : sweeps.rounding.map((p) => Math.log10(p[1]));
    const ends = kind === "cost" ? [] : sweeps.guides.map((guide) => Math.log10(guide[4]));
    const bottom = Math.min(found.yaxis.range[0], ...bounds.map(Math.floor)), top = Math.max(...ends, -Infinity);
    // Above a guide there is room for its name.
    found.yaxis.range = [bottom, Math.max(found.yaxis.range[1], top + 0.1 * (top - bottom) || -Infinity)];
    const low = Math.log10(Math.min(...values)), high = Math.log10(Math.max(...values)), room = 0.08 * (high - low) + 0.04;
    Object.assign(found.xaxis, { type: "log", range: [low - room, high + room], exponentformat: "power" });
    found.xaxis.title.text = kind === "cost" ? "wall time per simulated second, s" : "time step, s";
    if (kind === "convergence") {
      const steps = [...new Set(values)].sort((a, b) => a - b);
      Object.assign(found.xaxis, { tickmode: "array", tickvals: steps, ticktext: steps.map(String) });
    }
    return found;
  }

  function layout(axis, data) {
    // Below the floor there is room for the words that say so.
    const high = axis.high + 0.1, low = axis.floor ? data.floor - 0.1 * (high - data.floor) : axis.low;
    const common = { gridcolor: colour("--grid"), linecolor: colour("--rule"), zeroline: false, tickcolor: colour("--rule") };
    return {
      autosize: true, margin: { l: 58, r: 12, t: 12, b: 40 }, showlegend: false, hovermode: "closest",
      dragmode: coarse.matches ? false : "zoom",
      paper_bgcolor: colour("--panel"), plot_bgcolor: colour("--panel"),
      font: { family: style.getPropertyValue("--sans"), size: 12, color: colour("--soft") },
      hoverlabel: { align: "left" },
      xaxis: { ...common, title: { text: "time, s", standoff: 6 } },
      yaxis: { ...common, type: "log", range: [low, high], exponentformat: "power", dtick: Math.max(1, Math.ceil((high - low) / 8)) },
      shapes: axis.floor ? [{ type: "line", xref: "paper", x0: 0, x1: 1, y0: 10 ** data.floor, y1: 10 ** data.floor, line: { color: colour("--soft"), width: 1, dash: "dot" }, layer: "below" }] : [],
      annotations: axis.floor ? [{ xref: "paper", x: 1, xanchor: "right", yref: "y", y: data.floor, yanchor: "top", showarrow: false, text: `floor: zero to 10<sup>${data.floor}</sup> is drawn here`, font: { size: 11 } }] : [],
    };
  }

  const settings = { displayModeBar: false, responsive: true };

  async function draw(section) {
    if (!section.dirty) return;
    section.dirty = false;
    try {
      const loaded = await load(), scenario = loaded.data.scenarios[section.node.id];
      const caption = scenario.steps[rankIn(scenario)];
      for (const span of section.node.querySelectorAll(".at-step")) span.textContent = ` · ${caption}`;
      section.charts.forEach((chart, place) => {
        const kind = chart.dataset.kind;
        if (kind) Plotly.react(chart, sweepTraces(loaded, scenario.sweeps, kind), sweepLayout(scenario.sweeps, loaded.data, kind), settings);
        else Plotly.react(chart, traces(loaded, scenario, place), layout(scenario.charts[place], loaded.data), settings);
      });
      root.dataset.drawn = Number(root.dataset.drawn || 0) + section.charts.length;
    } catch (error) {
      console.error(error);
      element("no-charts").hidden = false;
      element("no-charts").textContent = `The charts cannot be drawn in this browser (${error.message}); every number stands in the tables.`;
    }
  }

  const sections = [...document.querySelectorAll(".scenario")]
    .map((node) => ({ node, charts: [...node.querySelectorAll(".chart")], dirty: true, near: false }))
    .filter((section) => section.charts.length);
  if (!sections.length) return;

  const redraw = () => sections.forEach((section) => {
    section.dirty = true;
    if (section.near) draw(section);
  });
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const section = sections.find((s) => s.node === entry.target);
      section.near = entry.isIntersecting;
      if (section.near) draw(section);
    }
  }, { rootMargin: "400px 0px" });
  sections.forEach((section) => observer.observe(section.node));

  // One legend for the whole page: a box for each line, and one for all of an engine's.
  for (const group of document.querySelectorAll("fieldset[data-engine]")) {
    const all = group.querySelector(".all"), ones = [...group.querySelectorAll(".one")];
    const settle = () => {
      const on = ones.filter((box) => box.checked).length;
      all.checked = on > 0;
      all.indeterminate = on > 0 && on < ones.length;
      for (const box of ones) box.checked ? hidden.delete(Number(box.value)) : hidden.add(Number(box.value));
      redraw();
    };
    all.addEventListener("change", () => { ones.forEach((box) => { box.checked = all.checked; }); settle(); });
    ones.forEach((box) => box.addEventListener("change", settle));
    if (ones.some((box) => !box.checked)) settle();
  }
  step.addEventListener("change", redraw);
  dark.addEventListener("change", redraw);
  element("lines").open = !narrow.matches;
  const controls = document.querySelector(".controls");
  new ResizeObserver(() => root.style.setProperty("--covered", `${controls.offsetHeight}px`)).observe(controls);
  addEventListener("beforeprint", () => { printing = true; sections.forEach((s) => { s.dirty = true; draw(s); }); });
  addEventListener("afterprint", () => { printing = false; redraw(); });
})();
