// Charts are drawn when they come near; one legend and one step act on all of them.
function parts(section, chart, loaded, scenario) {
  const kind = chart.dataset.kind;
  if (kind === "equation") return [equationTraces(loaded, scenario), equationLayout(scenario, loaded.data)];
  if (kind) return [sweepTraces(loaded, scenario, kind), sweepLayout(scenario, loaded.data, kind)];
  const place = Number(chart.dataset.place), bounds = boundTraces(loaded, scenario, place);
  return [[...bounds, ...deviationTraces(loaded, scenario, place)], deviationLayout(scenario, place, loaded.data, bounds)];
}

async function draw(section) {
  if (!section.dirty) return;
  section.dirty = false;
  try {
    const loaded = await load(), scenario = loaded.data.scenarios[section.node.id];
    const caption = scenario.steps[rankIn(scenario)];
    for (const span of section.node.querySelectorAll(".at-step")) span.textContent = ` · ${caption}`;
    for (const chart of section.charts) {
      const [traces, found] = parts(section, chart, loaded, scenario);
      await quietly(() => Plotly.react(chart, traces, zoomedLayout(section, chart, found), settings));
      link(section, chart);
    }
    root.dataset.drawn = Number(root.dataset.drawn || 0) + section.charts.length;
  } catch (error) {
    console.error(error);
    element("no-charts").hidden = false;
    element("no-charts").textContent = `The charts cannot be drawn in this browser (${error.message}); every number is in the tables.`;
  }
}

const sections = [...document.querySelectorAll(".scenario")]
  .map((node) => ({ node, charts: [...node.querySelectorAll(".chart")], dirty: true, near: false, range: null }))
  .filter((section) => section.charts.length);

const redraw = () => sections.forEach((section) => {
  section.dirty = true;
  if (section.near) draw(section);
});

// One legend for the whole page: a box for each line, and one for all of an engine's.
function legend(group) {
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

if (sections.length) {
  const observer = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const section = sections.find((s) => s.node === entry.target);
      section.near = entry.isIntersecting;
      if (section.near) draw(section);
    }
  }, { rootMargin: "400px 0px" });
  sections.forEach((section) => observer.observe(section.node));
  document.querySelectorAll("fieldset[data-engine]").forEach(legend);
  step.addEventListener("change", redraw);
  dark.addEventListener("change", redraw);
  element("lines").open = !narrow.matches;
  const controls = document.querySelector(".controls");
  new ResizeObserver(() => root.style.setProperty("--covered", `${controls.offsetHeight}px`)).observe(controls);
  // Printing does not wait: what it needs is unpacked as soon as the page is idle.
  const print = (on) => { printing = on; root.classList.toggle("printing", on); };
  addEventListener("beforeprint", () => { print(true); sections.forEach((s) => { s.dirty = true; draw(s); }); });
  addEventListener("afterprint", () => { print(false); redraw(); });
  addEventListener("load", () => (window.requestIdleCallback ?? setTimeout)(load));
}
