// Copying text, with a fallback for pages that may not use the clipboard, and feedback on it.
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

// A button that copies what `text` returns when it is pressed, and reports the result.
function copyButton(label, text) {
  const button = made("button", { type: "button", className: "copy", textContent: label });
  const feedback = made("span", { className: "feedback" });
  feedback.setAttribute("role", "status");
  button.addEventListener("click", async () => {
    feedback.textContent = "";
    feedback.textContent = (await copyText(text())) ? "copied" : "this browser refuses; select and copy by hand";
  });
  return [button, feedback];
}
