// Records: samples and what was uploaded, in one list for all parts of the page that shake with them.

import { remove, upload } from "./api.js";
import { el, notice, opener } from "./dom.js";

let samples = [], uploaded = [];

export function start(about, kept) { samples = about.samples; uploaded = kept; }
export const all = () => uploaded;

// What describes a station goes with the records; one of several files is for a single run.
const single = one => !/\.xml$/i.test(one.name) && one.files === 1;

// Files at once: a part of the record "given", or each a record of its own, for which what describes a station holds.
export async function take(files, joined) {
  const found = [];
  for (const file of files) {
    const first = found[0], how = first ? `?${joined ? "with" : "beside"}=${encodeURIComponent(first.id)}` : "";
    try {
      const one = await upload("/api/records" + how, file);
      uploaded = [...uploaded.filter(other => other.id !== one.id), one];
      if (joined) found[0] = one; else found.push(one);
    } catch (error) { notice(`${file.name}: ${error.error}`); }
  }
  return found;
}

export async function forget(id) {
  try { await remove(`/api/records/${id}`); } catch { /* it is gone already */ }
  uploaded = uploaded.filter(one => one.id !== id);
}

// Records to tick, and buttons that upload more; in the order in which they were ticked where that counts.
export function pick(get, set, ordered = false) {
  const chosen = get();
  const list = [...samples.map(one => [`sample:${one.name}`, one.name, one.about]), ...uploaded.filter(single).map(one => [one.id, one.name, "uploaded"])];
  const more = async files => {
    if (files.length > 300) { notice(`${files.length} files are too many at once; choose up to 300.`); return; }
    const found = await take(files, false);
    set([...get(), ...found.filter(single).map(one => one.id)]);
  };
  const files = opener("records", more, { multiple: true });
  const folder = opener("folder", list => more(list.filter(one => !one.name.startsWith("."))), { multiple: true, webkitdirectory: true });
  const tick = id => event => set(event.target.checked ? [...chosen, id] : chosen.filter(one => one !== id));
  return [
    el("div", { class: "row" }, el("button", { type: "button", onclick: () => files.click() }, "Upload records …"), files,
      el("button", { type: "button", onclick: () => folder.click() }, "Upload a folder …"), folder,
      el("button", { type: "button", class: "quiet", onclick: () => set(chosen.length === list.length ? [] : list.map(one => one[0])) }, "All or none")),
    el("ul", { class: "pick" }, list.map(([id, name, about]) => el("li", {}, el("label", { title: about }, el("input", { type: "checkbox", checked: chosen.includes(id), "data-key": id, onchange: tick(id) }), name),
      ordered && chosen.includes(id) && el("small", {}, `${chosen.indexOf(id) + 1}.`)))),
  ];
}

// Files have names of their own here; people know them by those that they had.
export const named = text => uploaded.reduce((said, one) => said.replace(new RegExp(`[\\w/-]*-${one.id}(\\.\\w+)?`, "g"), () => one.name), text);
