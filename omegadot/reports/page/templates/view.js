// The controls of the 3-D view.
// What the reader has picked stays from scenario to scenario; else each opens with its own.
const picked = { runs: false, step: false, mode: false };
function choose() {
  const number = Number(element("view-scenario").value), scenario = loaded.data.scenarios[number];
  const fresh = scenario !== show.scenario;
  if (fresh) {
    exact = exactTrajectory(loaded, scenario);
    // It opens at the end, where the runs are farthest apart; playing begins at the start.
    Object.assign(show, { scenario, time: exact.end, playing: false });
    clock.runs = false;
    element("view-play").textContent = "Play";
    element("view-time").max = exact.end;
    element("view-time").step = exact.end / 1000;
    offer(scenario);
    if (!picked.step) element("view-step").value = scenario.rank;
    if (!picked.mode) element("view-mode").value = scenario.everyone ? "all" : "runs";
  }
  const rank = Number(element("view-step").value || 0);
  clearScenes(show);
  show.all = element("view-mode").value === "all";
  refine(show.all);
  scenario.geometry = (scenario.geometries ??= {})[detail.sides] ??= geometryOf(scenario.body);
  scenario.tipOverReach = times(scenario.tip, 1 / scenario.geometry.reach);
  show.shown = show.all ? allShown(scenario, rank) : pickedShown(scenario, rank);
  element("view-runs").replaceChildren(...(show.all ? [] : show.shown.map((one) => one.item)));
  element("view-wall").replaceChildren(...(show.all ? show.shown.map((one) => one.item) : []));
  for (const node of document.querySelectorAll("[data-mode]")) node.hidden = (node.dataset.mode === "all") !== show.all;
  for (const name of ["overlaid", "polhode"]) element(`view-${name}`).disabled = show.all;
  element("view-description").textContent = `${scenario.title}: ${scenario.description}, ${scenario.pivot ? "held at its pivot" : "its centre of mass kept in the middle"}; the world's z axis is up.`
    + (scenario.coarse ? " It turns by more than a right angle between stored samples: what is shown between them is a guess." : "");
  element("view-charts").href = `#${scenario.anchor}`;
  tabulate(scenario);
  settle();
  announce(fresh ? `${scenario.title}.` : "");
}

function settle() {
  const checked = (id) => element(id).checked;
  show.options = { overlaid: !show.all && checked("view-overlaid"), polhode: !show.all && checked("view-polhode"), trace: checked("view-trace"), vectors: vectorsOf(show.scenario) };
  if (show.all) placeCells(show);
  render();
}

async function begin() {
  const { data, codes } = await arrive("three-data", "view-data", "view-codes");
  startWebgl();
  noteWebgl();
  loaded = { data, codes: new Int16Array(codes.buffer) };
  choose();
  measure();
  connect();
  box.dataset.ready = "1";
}

function connect() {
  const page = element("step"), own = element("view-step");
  element("view-scenario").addEventListener("change", choose);
  element("view-mode").addEventListener("change", () => { picked.mode = true; choose(); });
  element("view-which").addEventListener("change", choose);
  document.querySelectorAll(".view-engine").forEach((select) => select.addEventListener("change", () => { picked.runs = true; choose(); }));
  // One step for the whole page: a change here is a change there.
  own.addEventListener("change", () => {
    picked.step = true;
    if (page && page.value !== own.value) { page.value = own.value; page.dispatchEvent(new Event("change", { bubbles: true })); } else choose();
  });
  page?.addEventListener("change", () => { picked.step = true; own.value = page.value; choose(); });
  document.querySelectorAll(".view-option").forEach((input) => input.addEventListener("change", settle));
  element("view-play").addEventListener("click", () => play(!show.playing));
  element("view-time").addEventListener("input", (event) => { if (show.playing) play(false); goTo(Number(event.target.value)); });
  element("view-time").addEventListener("change", () => announce(""));
  for (const [id, angle] of [["view-turn", "azimuth"], ["view-tilt", "tilt"]]) {
    element(id).addEventListener("input", (event) => { show[angle] = Number(event.target.value); render(); });
  }
  night.addEventListener("change", measure);
  new ResizeObserver(measure).observe(box);
  drag(element("view-stage"));
}

function drag(stage) {
  let from = null;
  stage.addEventListener("pointerdown", (event) => { from = [event.clientX, event.clientY, show.azimuth, show.tilt]; stage.setPointerCapture(event.pointerId); });
  stage.addEventListener("pointerup", () => { from = null; });
  stage.addEventListener("pointercancel", () => { from = null; });
  stage.addEventListener("pointermove", (event) => {
    if (!from) return;
    const turned = from[2] - (event.clientX - from[0]) * 0.5;
    show.azimuth = ((((turned + 180) % 360) + 360) % 360) - 180;
    show.tilt = Math.max(-85, Math.min(85, from[3] + (event.clientY - from[1]) * 0.5));
    element("view-turn").value = show.azimuth;
    element("view-tilt").value = show.tilt;
    render();
  });
}

if (box) {
  box.hidden = false;
  let begun = false;
  const beginOnce = () => {
    if (begun) return;
    begun = true;
    rest().then(begin).catch((error) => { console.error(error); element("view-description").textContent = `The bodies cannot be drawn in this browser (${error.message}).`; });
  };
  new IntersectionObserver((entries) => {
    show.visible = entries.at(-1).isIntersecting;
    if (show.visible) beginOnce();
    run();
  }, { rootMargin: "100px 0px" }).observe(box);
  addEventListener("load", () => setTimeout(beginOnce, 300)); // for print
}
