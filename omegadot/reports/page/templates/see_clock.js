// What "See it" shows now, in pictures and in words, and its clock.
const box = element("see-box");
const show = { time: 0, playing: false, visible: false, azimuth: 35, tilt: 22, shown: [], scenario: null, options: {}, widths: {} };
const night = matchMedia("(prefers-color-scheme: dark)");
let loaded = null, exact = null;

// Asked for once, not for every picture: either may cost the browser a new layout of the page.
let look = null;
function measure() {
  const style = getComputedStyle(root), read = (name) => style.getPropertyValue(`--${name}`).trim();
  const names = ["ink", "soft", "rule", "panel", "shade", "sans"];
  look = { ...Object.fromEntries(names.map((name) => [name, read(name)])), mark: night.matches ? "#15181b" : "#ffffff" };
  show.widths = { stage: element("see-stage").clientWidth, errors: element("see-errors").clientWidth };
  render();
}
const seconds = (time) => `${time.toFixed(2)} s`;
const degrees = (angle) => `${angle < 10 ? angle.toFixed(1) : Math.round(angle)}°`;
const exactly = (angle) => `${angle >= 0.01 || angle === 0 ? Number(angle.toPrecision(2)) : angle.toExponential(1)}°`;
const fullName = (course) => course.name + (course.knob && ` at ${course.knob}`);

function errorOf(course) {
  return (angleBetween(poseAt(exact, show.time).q, poseAt(course, show.time).q) * 180) / Math.PI;
}
function partingOf(course) {
  if (course.parts !== null) return `parts from the exact solution at ${seconds(course.parts)}`;
  return `stays within ${loaded.data.parted}° of the exact solution (largest error ${exactly(course.largest)})`;
}

// H = R I omega and omega, world axes, each over the exact one's greatest.
function vectorsOf(scenario) {
  const momentum = (w) => across(scenario.inertia, w), most = (list) => Math.max(...list.map((v) => Math.hypot(...v))) || 1;
  const [h, spin] = [most(exact.w.map(momentum)), most(exact.w)];
  return (q, w) => [
    ...(element("see-momentum").checked ? [[times(rotate(q, momentum(w)), 0.95 / h), "H", false]] : []),
    ...(element("see-omega").checked ? [[times(rotate(q, w), 0.8 / spin), "ω", true]] : []),
  ];
}

function render() {
  if (!show.scenario || !show.widths.stage) return;
  for (const one of show.shown) {
    one.colour = one.course.line < 0 ? look.soft : loaded.data.lines[one.course.line].colour[night.matches ? 1 : 0];
    one.swatch.style.background = one.colour;
    if (one.course.line < 0) continue;
    const { ended } = poseAt(one.course, show.time), parted = one.course.parts !== null && one.course.parts <= show.time;
    const off = ended ? `no sample after ${seconds(one.course.end)}` : `${degrees(errorOf(one.course))} off`;
    if (one.number.textContent !== off) one.number.textContent = off;
    one.state = off + (parted ? `, parted ${seconds(one.course.parts)}` : "");
    one.item.classList.toggle("parted", parted);
  }
  paintStage(element("see-stage"), show, look);
  paintErrors(element("see-errors"), show, look);
  element("see-time").value = show.time;
  element("see-time").setAttribute("aria-valuetext", `${seconds(show.time)} of ${seconds(exact.end)}`);
  element("see-now").textContent = seconds(show.time);
}

// What the picture shows, in words: for the eye when it stands, for the ear when it changes.
function say(text) {
  const off = show.shown.slice(1).map((one) => `${one.course.name} ${degrees(errorOf(one.course))} off`);
  const words = `${text} At ${seconds(show.time)}: ${off.join(", ") || "the exact solution alone"}.`.trim();
  if (box.dataset.ready) element("see-said").textContent = words;
  element("see-stage").setAttribute("aria-label", `The body of ${show.scenario.name}, turning. ${words}`);
}

function play(on) {
  if (on && show.time >= exact.end) goTo(0);
  show.playing = on;
  element("see-play").textContent = on ? "Pause" : "Play";
  say(on ? "Playing." : "Paused.");
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
    show.time = Math.min(exact.end, show.time + Number(element("see-speed").value) * passed);
    for (const { course } of show.shown) {
      if (course.parts > before && course.parts <= show.time) say(`${course.name} ${partingOf(course)}.`);
    }
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
