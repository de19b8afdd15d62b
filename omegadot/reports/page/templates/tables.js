// Every table sorts by any column, filters by a text, copies as CSV; those in a closed part of the
// page are prepared when it is opened.
const leading = /^[-−]?\d+(\.\d+)?(e[-+]?\d+)?(?![\w.])/;

// A cell as text, without its links to the glossary and what keeps its exponents on one line.
const isTerm = (node) => node.classList?.contains("term") ?? false;
const textOf = (cell) => [...cell.childNodes].filter((n) => !isTerm(n)).map((n) => n.textContent).join("").replace(/\u2060/g, "").replace(/\s+/g, " ").trim();

// The lowest head cell of each column, and the texts of all head cells above it.
function columnsOf(table) {
  const grid = [...table.tHead.rows].map(() => []);
  [...table.tHead.rows].forEach((row, y) => {
    for (const cell of row.cells) {
      let x = 0;
      while (grid[y][x]) x++;
      for (let dy = 0; dy < cell.rowSpan; dy++) for (let dx = 0; dx < cell.colSpan; dx++) grid[y + dy][x + dx] = cell;
    }
  });
  return grid.at(-1).map((cell, x) => ({ cell, heads: [...new Set(grid.map((row) => row[x]))].map(textOf) }));
}

// The number that is read in a cell: of the matrix that which is shown.
function sizeOf(cell) {
  const shown = [...cell.querySelectorAll(".n")].find((n) => n.offsetWidth > 0);
  const text = textOf(shown ?? cell);
  if (text === "not finite" || text === "no number") return Infinity;
  const found = leading.exec(text);
  return found ? Number(found[0].replace("−", "-")) : null;
}

function sortBy(table, column, place) {
  const down = column.cell.getAttribute("aria-sort") === "ascending", sign = down ? -1 : 1;
  for (const cell of table.tHead.querySelectorAll("[aria-sort]")) cell.removeAttribute("aria-sort");
  column.cell.setAttribute("aria-sort", down ? "descending" : "ascending");
  const rows = [...table.tBodies[0].rows].map((row) => {
    const cell = row.cells[place], text = cell ? textOf(cell) : "";
    return { row, text: text === "–" ? "" : text, size: cell ? sizeOf(cell) : null, rank: Number(cell?.dataset.rank ?? 0) };
  });
  const numeric = rows.every(({ text, size }) => !text || size !== null);
  // What has no value stays last, whichever way.
  rows.sort((a, b) => !a.text - !b.text || sign * (a.rank - b.rank
    || (numeric ? (a.size ?? -Infinity) - (b.size ?? -Infinity) || 0 : a.text.localeCompare(b.text, "en", { numeric: true }))));
  table.tBodies[0].append(...rows.map(({ row }) => row));
}

// A cell that a spreadsheet would take for a formula is kept a text.
function csvCell(text) {
  const safe = /^[=@+\t\r]|^-(?![\d.])/.test(text) ? `'${text}` : text;
  return /[",\n\r]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}

function csvOf(table, columns) {
  const titles = columns.map(({ heads }) => heads.join(": "));
  const rows = [...table.tBodies[0].rows].filter((row) => !row.classList.contains("out"));
  return [titles, ...rows.map((row) => [...row.cells].map(textOf))].map((line) => line.map(csvCell).join(",")).join("\r\n") + "\r\n";
}

function toolbar(table, columns) {
  const name = (table.caption && textOf(table.caption)) ?? table.closest("[aria-label]")?.getAttribute("aria-label") ?? "table";
  const filter = made("input", { type: "search", placeholder: "filter rows" }), count = made("span", { className: "feedback" });
  filter.setAttribute("aria-label", `Filter the rows of: ${name}`);
  count.setAttribute("role", "status");
  filter.addEventListener("input", () => {
    const wanted = filter.value.toLowerCase().split(/\s+/).filter(Boolean), rows = [...table.tBodies[0].rows];
    for (const row of rows) row.classList.toggle("out", !wanted.every((text) => row.textContent.toLowerCase().includes(text)));
    count.textContent = wanted.length ? `${rows.filter((row) => !row.classList.contains("out")).length} of ${rows.length} rows` : "";
  });
  const [copy, feedback] = copyButton("Copy as CSV", () => csvOf(table, columns));
  copy.setAttribute("aria-label", `Copy as CSV: ${name}`);
  return made("div", { className: "tools" }, filter, count, copy, feedback);
}

// A table that is cut fades at the edge behind which there is more.
const widths = new ResizeObserver((entries) => entries.forEach(({ target }) => fade(target)));
const fade = (box) => box.classList.toggle("cut", box.scrollWidth - box.clientWidth - box.scrollLeft > 1);
function fadeAtEdge(box) {
  box.addEventListener("scroll", () => fade(box), { passive: true });
  widths.observe(box);
}

function enhance(table) {
  if (table.dataset.ready || !table.tHead || !table.tBodies.length) return;
  table.dataset.ready = "yes";
  const columns = columnsOf(table);
  columns.forEach((column, place) => {
    const links = [...column.cell.childNodes].filter(isTerm);
    const button = made("button", { type: "button", className: "sort" }, ...[...column.cell.childNodes].filter((n) => !isTerm(n)));
    button.addEventListener("click", () => sortBy(table, column, place));
    column.cell.replaceChildren(button, ...links.flatMap((a) => [" ", a]));
  });
  for (const row of table.tBodies[0].querySelectorAll("tr[data-source]")) {
    const heads = [...row.cells].filter((c) => c.scope === "row"), cell = row.querySelector(".origin") ?? heads[1] ?? heads[0];
    const source = made("button", { type: "button", className: "source", title: "Where this row comes from" }, ...cell.childNodes);
    source.setAttribute("aria-haspopup", "dialog");
    cell.append(source);
  }
  const scrolled = table.closest(".scroll");
  (scrolled ?? table).before(toolbar(table, columns));
  if (scrolled) fadeAtEdge(scrolled);
}

for (const table of document.querySelectorAll("main table")) if (!table.closest("details:not([open])")) enhance(table);
document.addEventListener("toggle", (event) => {
  if (event.target.matches("details[open]")) event.target.querySelectorAll("table").forEach(enhance);
}, true);
