// What the 3-D view shows now, as a picture and as text, and its clock.
const box = element("view-box");
const show = { time: 0, playing: false, visible: false, azimuth: 35, tilt: 22, shown: [], scenario: null, all: false, polhode: null, options: {}, widths: {} };
const night = matchMedia("(prefers-color-scheme: dark)");
let loaded = null, exact = null;

// Asked for once, not for every picture: either may cost the browser a new layout of the page.
let theme = null;
function measure() {
  const style = getComputedStyle(root), read = (name) => style.getPropertyValue(`--${name}`).trim();
  const names = ["ink", "soft", "rule", "stand", "panel", "shade", "sans", "fail-back"];
  theme = { ...Object.fromEntries(names.map((name) => [name, read(name)])), mark: night.matches ? "#15181b" : "#ffffff" };
  show.widths = { stage: element("view-stage").clientWidth, errors: element("view-errors").clientWidth };
  if (show.all) placeCells(show);
  clearScenes(show);
  render();
}
const tell = (node, text) => { if (node.textContent !== text) node.textContent = text; };
const seconds = (time) => `${time.toFixed(2)} s`;
const degrees = (angle) => `${angle < 10 ? angle.toFixed(1) : Math.round(angle)}°`;
const exactly = (angle) => `${written(angle, angle < 100 ? 2 : 3)}°`;
const fullName = (trajectory) => trajectory.name + (trajectory.knob && ` at ${trajectory.knob}`);

function errorOf(trajectory) {
  return (angleBetween(poseAt(exact, show.time).q, poseAt(trajectory, show.time).q) * 180) / Math.PI;
}
function divergenceOf(trajectory) {
  if (trajectory.diverges !== null) return `diverges from the exact solution at ${seconds(trajectory.diverges)}`;
  return `stays within ${loaded.data.diverged}° of the exact solution (largest error ${exactly(trajectory.largest)})`;
}

// H = R I omega and omega, world axes, each over the exact one's greatest: long enough to leave the body.
function vectorsOf(scenario) {
  const momentum = (w) => across(scenario.inertia, w), most = (list) => Math.max(...list.map((v) => Math.hypot(...v))) || 1;
  const [h, spin] = [most(exact.w.map(momentum)), most(exact.w)];
  return (q, w) => [
    ...(element("view-momentum").checked ? [[times(rotate(q, momentum(w)), 1.1 / h), "H", false]] : []),
    ...(element("view-omega").checked ? [[times(rotate(q, w), 0.95 / spin), "ω", true]] : []),
  ];
}

function render() {
  if (!show.scenario || !show.widths.stage) return;
  for (const one of show.shown) {
    one.colour = one.trajectory.line < 0 ? theme.soft : loaded.data.lines[one.trajectory.line].colour[night.matches ? 1 : 0];
    one.swatch.style.background = one.colour;
    const { ended } = poseAt(one.trajectory, show.time), diverged = one.trajectory.diverges !== null && one.trajectory.diverges <= show.time;
    if (one.turned) tell(one.turned, flipsText(one.trajectory, show.scenario.flips, show.time));
    if (one.trajectory.line < 0) continue;
    const off = ended ? `no sample after ${seconds(one.trajectory.end)}` : `${degrees(errorOf(one.trajectory))} off`;
    tell(one.number, off);
    one.status = off + (diverged ? `, diverged at ${seconds(one.trajectory.diverges)}` : "");
    one.item.classList.toggle("diverged", diverged);
  }
  paintStage(element("view-stage"), show, theme);
  paintErrors(element("view-errors"), show, theme);
  element("view-time").value = show.time;
  element("view-time").setAttribute("aria-valuetext", `${seconds(show.time)} of ${seconds(exact.end)}`);
  element("view-now").textContent = seconds(show.time);
}

// What the picture shows, as text: read out when it changes.
function announce(text) {
  const off = show.shown.slice(1).map((one) => `${one.trajectory.name} ${degrees(errorOf(one.trajectory))} off`);
  const content = `${text} At ${seconds(show.time)}: ${show.all ? wallText(show) : off.join(", ") || "the exact solution alone"}.`.trim();
  if (box.dataset.ready) element("view-status").textContent = content;
  element("view-stage").setAttribute("aria-label", `The body of ${show.scenario.name}, turning. ${content}`);
}

function play(on) {
  if (on && show.time >= exact.end) goTo(0);
  show.playing = clock.runs = on;
  if (!on) render();
  element("view-play").textContent = on ? "Pause" : "Play";
  announce(on ? "Playing." : "Paused.");
  run();
}
let waiting = false, last = 0;
function run() {
  if (waiting || !show.playing || !show.visible) return;
  waiting = true;
  last = performance.now();
  const tick = (now) => {
    waiting = show.playing && show.visible;
    if (!waiting) return;
    const before = show.time, passed = Math.min(100, Math.max(0, now - last)) / 1000;
    last = now;
    show.time = Math.min(exact.end, show.time + Number(element("view-speed").value) * passed);
    const over = show.shown.filter(({ trajectory }) => trajectory.diverges > before && trajectory.diverges <= show.time);
    const messages = over.map(({ trajectory }) => `${trajectory.name} ${divergenceOf(trajectory)}.`);
    for (const text of show.all && messages.length ? [messages.join(" ")] : messages) announce(text); // many at once are one message
    if (show.time >= exact.end) {
      waiting = false;
      play(false);
    } else requestAnimationFrame(tick);
    render();
  };
  requestAnimationFrame(tick);
}
function goTo(time) {
  show.time = Math.min(exact.end, Math.max(0, time));
  render();
}
