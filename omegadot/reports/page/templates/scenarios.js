// One scenario at a time: tabs, addresses that lead to one, and all of them on paper.
const panels = [...document.querySelectorAll(".scenario")], tabs = [...document.querySelectorAll("#tabs a")];
const folds = new Set(); // the folds that are open, by what they hold: so they stay from tab to tab
const nameOfFold = (fold) => fold.querySelector("summary").textContent;

// What a closed fold holds is kept aside until it is opened.
const aside = new WeakMap();
function fill(node) {
  const content = made("template", { innerHTML: node.querySelector("noscript").textContent }).content;
  for (const fold of content.querySelectorAll("details")) {
    fold.open = folds.has(nameOfFold(fold));
    if (!fold.open) aside.set(fold, [...fold.childNodes].filter((child) => child.tagName !== "SUMMARY"));
    aside.get(fold)?.forEach((child) => child.remove());
  }
  node.append(content);
  node.hidden = false;
}

function unfold(fold) {
  fold.append(...(aside.get(fold) ?? []));
  aside.delete(fold);
  fold.querySelectorAll("table").forEach(enhance);
}

function clear(node) {
  for (const chart of node.querySelectorAll(".live")) Plotly.purge(chart);
  node.replaceChildren(node.querySelector("noscript"));
  node.hidden = true;
}

function show(node) {
  if (current?.node === node) return;
  const height = scrollY, before = current?.node;
  fill(node);
  if (before) clear(before);
  nearby.disconnect();
  current = { node, charts: [...node.querySelectorAll(".chart")], range: null };
  for (const table of node.querySelectorAll("table")) if (!table.closest("details:not([open])")) enhance(table);
  for (const [place, tab] of tabs.entries()) {
    const own = panels[place] === node;
    tab.setAttribute("aria-selected", own);
    tab.tabIndex = own ? 0 : -1;
    if (own && element("current")) element("current").textContent = tab.childNodes[1].textContent;
  }
  current.charts.forEach((chart) => nearby.observe(chart));
  if (root.dataset.changed) redraw();
  if (before) scrollTo(0, height);
}

function turn(place, focus) {
  const node = panels.at(place % panels.length);
  show(node);
  history.replaceState(null, "", `#${node.id}`);
  if (focus) tabs[panels.indexOf(node)].focus({ preventScroll: true });
}

// An address of no part of this page, such as an old link to a scenario, leads to a notice.
function follow() {
  const name = address(), node = panels.find((panel) => panel.id === name), notice = element("missing");
  notice.hidden = !name || Boolean(node ?? element(name));
  if (!notice.hidden) {
    notice.textContent = `This report has no scenario “${name.replace(/^scenario-/, "")}”. Choose one above.`;
    (element("tabs") ?? notice).scrollIntoView();
  }
  if (!node) return false;
  show(node);
  node.scrollIntoView();
  return true;
}

function address() {
  try { return decodeURIComponent(location.hash.slice(1)); } catch { return location.hash.slice(1); }
}

if (panels.length) {
  for (const [place, tab] of tabs.entries()) {
    tab.id = `tab-${place}`;
    for (const [name, value] of [["role", "tab"], ["aria-controls", panels[place].id]]) tab.setAttribute(name, value);
    panels[place].setAttribute("role", "tabpanel");
    panels[place].setAttribute("aria-labelledby", tab.id);
    panels[place].removeAttribute("aria-label");
    panels[place].hidden = true;
  }
  element("tabs").setAttribute("role", "tablist");
  element("tabs").addEventListener("keydown", (event) => {
    const place = tabs.indexOf(event.target), moves = { ArrowLeft: place - 1, ArrowUp: place - 1, ArrowRight: place + 1, ArrowDown: place + 1, Home: 0, End: -1 };
    if (place < 0 || !(event.key in moves)) return;
    event.preventDefault();
    turn(moves[event.key], true);
  });
  document.addEventListener("toggle", (event) => {
    if (!event.target.closest(".scenario")) return;
    folds[event.target.open ? "add" : "delete"](nameOfFold(event.target));
    if (event.target.open) unfold(event.target);
  }, true);
  if (!follow()) show(panels.find((panel) => "opened" in panel.dataset) ?? panels[0]);
  addEventListener("hashchange", follow);
}

const controls = document.querySelector(".controls");
if (controls) {
  const changed = () => { root.dataset.changed = "1"; redraw(); };
  element("previous").addEventListener("click", () => turn(panels.indexOf(current.node) - 1));
  element("next").addEventListener("click", () => turn(panels.indexOf(current.node) + 1));
  controls.addEventListener("change", (event) => {
    if (event.target.matches("input")) select(event.target);
    changed();
  });
  element("lines").addEventListener("toggle", async () => settleBoxes((await load()).data.scenarios[current.node.id] ?? { first: [] }));
  dark.addEventListener("change", () => want(current.charts.filter((chart) => chart.data)));
  new ResizeObserver(() => root.style.setProperty("--covered", `${controls.offsetHeight}px`)).observe(controls);
}

// Paper gets every scenario: its pictures, and of the one shown the charts as they are if they were
// zoomed or show other lines than at first.
function print(on) {
  printing = on;
  const changed = Boolean(root.dataset.changed || current?.range || current?.charts.some((chart) => chart.zoomed || chart.zoomedAcross));
  current?.node.classList.toggle("changed", on && changed);
  root.classList.toggle("printing", on);
  for (const fold of document.querySelectorAll("header details, #settings details")) fold.open = on;
  for (const node of panels) if (node !== current.node) (on ? fill : clear)(node);
  if (changed) for (const chart of current.charts) if (chart.data) draw(current, chart);
}
addEventListener("beforeprint", () => print(true));
addEventListener("afterprint", () => print(false));
