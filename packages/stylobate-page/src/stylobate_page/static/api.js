// What the page asks of this machine. An answer that is no success is thrown, with its sentence and its field.

export class Refused extends Error {
  constructor(code, body) { super(body.error); this.code = code; this.error = body.error; this.field = body.field || null; }
}

async function ask(method, path, body, headers = {}) {
  let answer;
  try { answer = await fetch(path, { method, body, headers: { ...headers, "x-page": "yes" } }); }
  catch { throw new Refused(0, { error: "The page is not served any more: start it again, and open its new address." }); }
  if (answer.ok && !answer.headers.has("x-refused")) return answer;
  let said = null;
  try { said = await answer.json(); } catch { /* no sentence */ }
  throw new Refused(answer.status, said && said.error ? said : { error: `The page got no answer it knows (${answer.status}); reload it.` });
}

export const get = async path => (await ask("GET", path)).json();
export const remove = async path => (await ask("DELETE", path)).json();
export const post = async (path, body = {}) => (await ask("POST", path, JSON.stringify(body), { "content-type": "application/json" })).json();
// Is it right? An answer with a sentence about what is wrong is no failure of the question.
export const check = async (path, body) => {
  try {
    const found = await post(path, body);
    return found.error ? new Refused(200, found) : found;
  } catch (error) { return error; }
};
export const postText = async (path, body) => (await ask("POST", path, JSON.stringify(body), { "content-type": "application/json" })).text();
export const upload = async (path, file, more = {}) =>
  (await ask("POST", path, file, { "content-type": "application/octet-stream", "x-name": encodeURIComponent(file.name), ...more })).json();

// Answers may come in another order than they were asked for: only the last one asked for counts.
export function latest(run) {
  let number = 0;
  return async (...given) => { const mine = ++number, found = await run(...given); return mine === number ? found : null; };
}
