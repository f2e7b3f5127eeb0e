// Small tools for elements: made, found, told apart; and numbers as people read them.

// What fields are called, by what they stand for on the command line: messages of the library are put in the same words.
export const labels = {};

export const find = (selector, from = document) => from.querySelector(selector);

// el("p", { class: "hint", onclick: f }, "text", child): attributes, listeners (on…) and properties (values) of an element.
export function el(name, given = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(given)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) made[key] = value;
    else if (key === "value" || key === "checked" || key === "disabled" || key === "hidden") made[key] = value;
    else made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children.flat().filter(one => one !== null && one !== undefined && one !== false));
  return made;
}

export function fill(element, ...children) {
  element.replaceChildren(...children.flat().filter(one => one !== null && one !== undefined && one !== false));
  return element;
}

// Draws a form anew, and leaves where its list stood and what had the focus. A list of choices that has it stays where it is:
// taken out for a moment, it would forget the letters that were typed in it.
export function redraw(place, ...children) {
  const list = find(".pick", place), down = list ? list.scrollTop : 0, active = place.contains(document.activeElement) ? document.activeElement : null;
  const ends = active && active.type === "text" ? [active.selectionStart, active.selectionEnd] : null;
  const fresh = fill(el("div"), ...children), one = active && find(same(active), fresh);
  if (one && one.tagName === "SELECT" && texts(one) === texts(active)) {
    active.value = one.value; active.onchange = one.onchange;
    graft(place, fresh, active, one);
  } else {
    fill(place, ...fresh.childNodes);
    if (one) one.focus();
    if (one && ends && one.type === "text") one.setSelectionRange(...ends);
  }
  const again = find(".pick", place);
  if (again) again.scrollTop = down;
}
const texts = select => [...select.options || []].map(option => option.value).join("\n");
function same(active) {
  const name = ["key", "field"].find(one => active.dataset[one]);
  if (name) return `[data-${name}="${CSS.escape(active.dataset[name])}"]`;
  return active.type === "radio" ? `input[name="${CSS.escape(active.name)}"][value="${CSS.escape(active.value)}"]` : ":not(*)";
}
// What lies around an element is put in the place of what lay around another one, which stays.
function graft(old, fresh, stays, one) {
  if (old === stays) return;
  const [kept, come] = [[old, stays], [fresh, one]].map(([parent, inner]) => [...parent.childNodes].find(node => node.contains(inner)));
  const list = [...fresh.childNodes], k = list.indexOf(come);
  for (const node of [...old.childNodes]) if (node !== kept) node.remove();
  kept.before(...list.slice(0, k)); kept.after(...list.slice(k + 1));
  graft(kept, come, stays, one);
}

// A labelled control.
export const field = (label, control, ...more) => el("label", { class: "field" }, el("span", {}, label), control, ...more);

export function select(options, value, onchange, given = {}) {
  const made = el("select", { ...given, onchange: event => onchange(event.target.value) },
    options.map(([key, text]) => el("option", { value: key }, text)));
  made.value = value;
  return made;
}

// A hidden list of files to open. It forgets them, so that one that was mended can be opened again.
export const opener = (name, open, given = {}) => el("input", { type: "file", hidden: true, "data-upload": name, ...given,
  onchange: ({ target }) => { const files = [...target.files]; target.value = ""; open(files); } });

// One of several, as buttons side by side that are radio buttons to the keyboard.
export function choice(name, label, options, value, onchange) {
  return el("fieldset", {}, el("legend", {}, label), el("div", { class: "choice" }, options.map(([key, text]) =>
    el("label", {}, el("input", { type: "radio", name, value: key, checked: key === value, onchange: () => onchange(key) }), text))));
}

export function facts(pairs) {
  return el("dl", { class: "facts" }, pairs.filter(one => one && one[1] !== null && one[1] !== undefined && one[1] !== "")
    .map(([name, value]) => el("div", {}, el("dt", {}, name), el("dd", {}, value))));
}

export function number(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(digits - 1);
  return String(+value.toPrecision(Math.max(digits, Math.ceil(Math.log10(size)))));
}

export function length(value) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  return Math.abs(value) >= 1 ? number(value) + " m" : number(1000 * value) + " mm";
}

// Each once; of many the first few, and the others where they can be opened: what was computed stands below.
const SHOWN = 3;
export function warnings(list) {
  const made = [...new Set(list || [])].map(one => el("p", { class: "warning" }, one)), rest = made.slice(SHOWN);
  return rest.length < 2 ? made : [...made.slice(0, SHOWN), el("details", {}, el("summary", {}, `${rest.length} more warnings`), rest)];
}

// Says something at the foot of the page for a while.
let waiting = 0;
export function notice(text) {
  const place = find("#notice");
  place.textContent = text; place.hidden = false;
  clearTimeout(waiting);
  waiting = setTimeout(() => { place.hidden = true; }, 7000);
}

// A sentence begins with a capital, unless with the name of a file.
export const capital = text => /^[^\s,;:]+\.\w/.test(text) ? text : text[0].toUpperCase() + text.slice(1);

// Boxes that hold several parameters, by these.
const WITHIN = { region: "synthetic", magnitude: "synthetic", distance: "synthetic", seed: "synthetic", factor: "factors" };

// The field of a panel by its name; the row, or the box of several parameters, where it has no box for that.
export function control(panel, field) {
  const place = name => name && find(`[data-field="${CSS.escape(name)}"]`, panel);
  return field && (place(field) || place(WITHIN[field]) || (field.includes(".") && place(field.replace(/\.[^.]*$/, "")))) || null;
}

// Marks the field of a panel that a sentence is about, with the sentence under it; under the panel where it is about none.
export function mark(panel, error) {
  for (const one of panel.querySelectorAll("[data-made=error]")) one.remove();
  for (const one of panel.querySelectorAll("[aria-invalid]")) { one.removeAttribute("aria-invalid"); one.removeAttribute("aria-describedby"); }
  if (!error) return;
  const box = control(panel, error.field), said = el("p", { class: "error", role: "alert", id: "error-" + panel.id, "data-made": "error" }, capital(error.error));
  if (!box) { (find("[data-errors]", panel) || panel).append(said); return; }
  const line = box.matches("textarea") && /\.(\d+)$/.exec(error.field);
  if (box.matches("textarea")) box.style.backgroundPosition = `0 calc(.4rem + ${line ? line[1] - 1 : -99} * 1.45em)`;
  if (line) said.append(" ", el("button", { type: "button", onclick: () => goTo(box, +line[1]) }, `Line ${line[1]}`));
  box.setAttribute("aria-invalid", "true"); box.setAttribute("aria-describedby", said.id);
  const hidden = box.closest("details:not([open])");
  if (hidden) hidden.open = true;
  const row = box.closest("table.drums tr");
  if (row) row.after(el("tr", { "data-made": "error" }, el("td", { colspan: row.cells.length }, said)));
  else (box.closest(".field, .slider") || box).after(said);
}

// Goes to a line of a text that is edited, and selects it.
function goTo(box, line) {
  const lines = box.value.split("\n"), before = lines.slice(0, line - 1).join("\n").length + (line > 1);
  box.focus();
  box.setSelectionRange(before, before + (lines[line - 1] || "").length);
  box.scrollTop = box.scrollHeight * Math.max(0, line - 4) / lines.length;
}

export function save(name, content) {
  const link = el("a", { href: URL.createObjectURL(new Blob([content])), download: name });
  document.body.append(link); link.click(); link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// Calls a function once, when nothing has asked for it for a while.
export function later(run, wait) {
  let timer = 0;
  return (...given) => { clearTimeout(timer); timer = setTimeout(() => run(...given), wait); };
}
