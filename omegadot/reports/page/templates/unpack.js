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

let origins = null;
const loadOrigins = () => (origins ??= unpack("origins-data").then((r) => r.json()));
