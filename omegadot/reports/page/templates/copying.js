// Copying text, with a way for pages that may not touch the clipboard, and a word about it.
async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = made("textarea", { value: text, readOnly: true, className: "aside" });
    (document.querySelector("dialog[open]") ?? document.body).append(area);
    const before = document.activeElement;
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    before?.focus();
    return done;
  }
}

// A button that copies what `text` gives when it is pressed, and says how that went.
function copyButton(label, text) {
  const button = made("button", { type: "button", className: "copy", textContent: label });
  const said = made("span", { className: "said" });
  said.setAttribute("role", "status");
  button.addEventListener("click", async () => {
    said.textContent = "";
    said.textContent = (await copyText(text())) ? "copied" : "this browser refuses; select and copy by hand";
  });
  return [button, said];
}
