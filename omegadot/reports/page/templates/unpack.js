// What travels packed inside the page: base64, gzip, and for the errors 16-bit differences.
const root = document.documentElement;
root.classList.add("js");
const element = (id) => document.getElementById(id);
const made = (tag, properties = {}, ...children) => {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
};

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

// A library, which becomes part of the page, and what it draws.
async function arrive(...ids) {
  const [library, description, codes] = await Promise.all(ids.map(unpack));
  document.head.append(made("script", { textContent: await library.text() }));
  return { data: await description.json(), codes: undifference(new Uint8Array(await codes.arrayBuffer())) };
}

let loading = null;
const load = () => (loading ??= arrive("plotly-data", "charts-data", "codes-data"));

let origins = null;
const loadOrigins = () => (origins ??= unpack("origins-data").then((r) => r.json()));
