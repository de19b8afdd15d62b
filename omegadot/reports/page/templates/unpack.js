// What travels packed inside the page: base 85, gzip, and for the errors 16-bit differences.
const root = document.documentElement;
root.classList.add("js");
const element = (id) => document.getElementById(id);
const made = (tag, properties = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
};

const digits = new Uint8Array(128);
[..."0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%&()*+-;,=>?@^_`{|}~"].forEach((letter, k) => { digits[letter.charCodeAt(0)] = k; });

// Five letters are four bytes, the highest first; letters that are left out at the end are the last.
function bytesOf(text) {
  const count = Math.ceil(text.length / 5), view = new DataView(new ArrayBuffer(4 * count));
  for (let i = 0, k = 0; i < count; i++) {
    let word = 0;
    for (let j = 0; j < 5; j++, k++) word = word * 85 + (k < text.length ? digits[text.charCodeAt(k)] : 84);
    view.setUint32(4 * i, word);
  }
  return new Uint8Array(view.buffer, 0, 4 * count - (5 * count - text.length));
}

async function unpack(id) {
  const bytes = bytesOf(element(id).textContent.trim());
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

// A library, which becomes part of the page, and what it draws.
async function arrive(...ids) {
  const [library, description, codes] = await Promise.all(ids.map(unpack));
  document.head.append(made("script", { textContent: await library.text() }));
  return { data: await description.json(), codes: undifference(new Uint8Array(await codes.arrayBuffer())) };
}

// What takes long waits until the page is not being scrolled.
let scrolled = -Infinity;
addEventListener("scroll", () => { scrolled = performance.now(); }, { passive: true, capture: true });
const idle = () => new Promise((done) => { window.requestIdleCallback ? requestIdleCallback(done, { timeout: 400 }) : setTimeout(done); });
async function rest() {
  do {
    while (performance.now() - scrolled < 250) await new Promise((done) => { setTimeout(done, 100); });
    await idle();
  } while (performance.now() - scrolled < 250);
}

let loading = null;
const load = () => (loading ??= arrive("plotly-data", "charts-data", "codes-data"));

let origins = null;
const loadOrigins = () => (origins ??= unpack("origins-data").then((r) => r.json()));
