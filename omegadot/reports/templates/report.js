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
      const own = codes.subarray(from, from + count);
      const colour = look.colour[dark.matches && !printing ? 1 : 0];
      return {
        type: "scatter", mode: count > 1 ? "lines" : "markers", name: look.name,
        x: data.times[clock], y: Array.from(own, (code) => value(code, data)),
        text: Array.from(own, (code) => code === 0
          ? `at or below 1e${data.floor}` : value(code, data)?.toExponential(2) + unitText(axis.unit)),
        hovertemplate: "%{fullData.name}<br>%{x} s: %{text}<extra></extra>",
        line: { color: colour, width: look.width, dash: look.dash.replaceAll(" ", "px,") + (look.dash && "px") || "solid" },
        marker: { color: colour },
      };
    });
  }

  function layout(axis, data) {
    const style = getComputedStyle(root);
    const colour = (name) => style.getPropertyValue(name).trim();
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
        Plotly.react(chart, traces(loaded, scenario, place), layout(scenario.charts[place], loaded.data), settings);
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
