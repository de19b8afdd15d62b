// Where a number comes from: engine, version, integrator, step, seed, and the command.
const plainArgument = /^[\w@%+=:,./-]+$/;
const quoted = (text) => (plainArgument.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

function sourceOf(origins, number) {
  const [engine, version, setup, integrator, timestep, accuracy] = origins.sources[number];
  return { engine, version, setup, integrator, timestep, accuracy };
}

// A number that belongs to no single scenario comes from all that were requested.
function commandFor(origins, source, anchor) {
  if (origins.traces.includes(source.engine)) return origins.command; // a file's, not an engine's
  const requested = anchor ? [origins.scenarios[anchor][1]] : origins.requested;
  const engine = source.engine + (source.integrator ? `:${source.integrator}` : "");
  const steps = source.timestep === null ? origins.steps : [String(source.timestep)];
  const given = ["omegadot", "run", "--engine", engine, ...steps.flatMap((step) => ["--timestep", step])];
  if (origins.seed !== null) given.push("--seed", String(origins.seed));
  if (source.setup !== "physics") given.push("--setup", source.setup);
  given.push(...origins.options);
  const tail = requested.some((name) => name.startsWith("-")) ? ["--", ...requested] : [];
  if (!tail.length) given.splice(2, 0, ...requested);
  return [...given, ...tail].map(quoted).join(" ");
}

function facts(origins, source) {
  const list = made("dl");
  const named = [
    ["engine", `${source.engine} ${/^\d+$/.test(source.version) ? `(version ${source.version})` : source.version}`.trim()],
    ["setup", source.setup],
    ["integrator", source.integrator ?? "not applicable (no time stepping)"],
    ["step", source.timestep === null ? null : `${written(source.timestep)} s`],
    ["accuracy", source.accuracy === null ? null : written(source.accuracy)],
    ["seed", origins.seed],
  ];
  for (const [name, value] of named) {
    if (value !== null && value !== undefined) list.append(made("div", {}, made("dt", { textContent: name }), made("dd", { textContent: value })));
  }
  return list;
}

// It breaks between its arguments, not within, at the hyphens of an option.
const argumentsOf = (command) => command.split(" ").flatMap((text, k) => [...(k ? [" "] : []), text.includes("-") ? made("span", { className: "argument", textContent: text }) : text]);

function block(origins, anchor, number, numbers) {
  const source = sourceOf(origins, number), command = commandFor(origins, source, anchor);
  const pre = made("pre", { tabIndex: 0, className: "command" }, made("code", {}, ...argumentsOf(command)));
  const figures = numbers.map(([what, value]) => made("p", {}, made("b", { textContent: value }), ` ${what}`));
  return made("section", {}, ...figures, facts(origins, source), pre, made("p", {}, ...copyButton("Copy the command", () => command)));
}

// numbers: [[what, value, source], ...]; those of one source share a block.
function openCard(origins, title, anchor, numbers, lead = "") {
  const card = element("card"), body = card.querySelector(".body"), groups = new Map();
  for (const [what, value, number] of numbers) groups.set(number, [...(groups.get(number) ?? []), ...(what ? [[what, value]] : [])]);
  element("card-title").textContent = title + (anchor ? ` on ${origins.scenarios[anchor][0]}` : "");
  body.replaceChildren(...(lead ? [made("p", { textContent: lead })] : []));
  for (const [number, own] of groups) body.append(block(origins, anchor, number, own));
  if (anchor) {
    const link = made("a", { href: `#${anchor}`, textContent: "To the scenario" });
    link.addEventListener("click", () => card.close());
    body.append(made("p", {}, link));
  }
  card.showModal();
  card.scrollTop = 0;
}

const nameOf = (source) => [source.engine, source.integrator, source.setup === "physics" ? null : source.setup].filter(Boolean).join(" ");

async function rowCard(row) {
  const origins = await loadOrigins(), number = Number(row.dataset.source), source = sourceOf(origins, number);
  const anchor = row.dataset.anchor ?? row.closest(".scenario")?.id ?? null;
  const heads = [...row.cells].filter((cell) => cell.scope === "row").map((cell) => cell.textContent);
  openCard(origins, nameOf(source), anchor, [["", "", number]], anchor ? "" : `All scenarios of the run, in the row of ${heads.join(", ")}.`);
}

async function cellCard(link) {
  const origins = await loadOrigins();
  const [anchor, status, part, numbers, own] = origins.cards[Number(link.dataset.card)];
  const shown = numbers.length ? numbers : [["", "", own]];
  openCard(origins, nameOf(sourceOf(origins, own)), anchor, shown, [`Worst verdict: ${status}`, part].filter(Boolean).join("; ") + ".");
}

// A term is explained in place; its place in the glossary is a link from there.
function termCard(link) {
  const card = element("card"), name = element(link.hash.slice(1)), place = made("a", { href: link.hash, textContent: "In the glossary" });
  element("card-title").textContent = name.textContent;
  place.addEventListener("click", () => card.close());
  card.querySelector(".body").replaceChildren(made("p", {}, ...name.nextElementSibling.cloneNode(true).childNodes), made("p", {}, place));
  card.showModal();
}

for (const link of document.querySelectorAll("a[data-card]")) {
  link.setAttribute("role", "button");
  link.setAttribute("aria-haspopup", "dialog");
  link.title = "Where these numbers come from, and the command that reproduces them";
}
document.addEventListener("click", (event) => {
  const link = event.target.closest?.("a[data-card]"), source = event.target.closest?.("button.source"), term = event.target.closest?.("a.term");
  if (term) {
    event.preventDefault();
    termCard(term);
  } else if (link) {
    event.preventDefault();
    cellCard(link);
  } else if (source) rowCard(source.closest("tr"));
});
document.addEventListener("keydown", (event) => {
  if (event.key !== " " || !event.target.matches?.("a[data-card]")) return;
  event.preventDefault();
  cellCard(event.target);
});
element("card").addEventListener("click", (event) => {
  if (event.target === event.currentTarget) event.currentTarget.close();
});
