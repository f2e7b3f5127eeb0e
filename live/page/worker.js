// Computes films and maps beside the page: a piece at a time, so that it hears when something else is wanted.
"use strict";

const PIECE = 12; // of work without a look at what is wanted [ms]
let engine = null, wanted = 0;

onmessage = ({ data: message }) => {
  if (message.data) {
    engine = new Engine(message.module, message.data);
    return;
  }
  wanted = message.id;
  if (message.kind) run(message.kind === "film" ? film(message) : map(message), message.id);
};

// Go on with a task until it is done or another one is wanted.
function run(task, id) {
  const channel = new MessageChannel();
  channel.port1.onmessage = () => {
    if (id !== wanted) return;
    const end = performance.now() + PIECE;
    let done = false;
    try {
      while (!done && performance.now() < end) done = task.next().done;
    } catch (error) {
      postMessage({ id, kind: "failed", reason: String(error) });
      return;
    }
    if (!done) channel.port2.postMessage(0);
  };
  channel.port2.postMessage(0);
}

// All lanes under one motion: poses sixty times a second of the film, and verdicts as they come.
function* film({ id, column, request, shown }) {
  engine.load(column);
  const placed = engine.place(motionOf(engine.data, request));
  for (let lane = 0; lane < LANES; lane++) engine.begin(lane, placed, shown);
  const dt = engine.real("kept", "dt", 0), { chunk } = engine.data;
  const each = Math.max(1, Math.round(1 / 60 / (chunk * dt)));
  const known = new Array(LANES).fill(false);
  let times = [0], poses = [engine.poses()], verdicts = [], sent = performance.now(), step = 0;
  const send = (over) => {
    postMessage({ id, kind: "film", times, poses, verdicts, over }, poses.map((item) => item.buffer));
    [times, poses, verdicts, sent] = [[], [], [], performance.now()];
  };
  while (engine.running()) {
    engine.advance(each);
    const now = engine.now();
    step = now || step + each * chunk;
    times.push(step * dt);
    poses.push(engine.poses());
    for (let lane = 0; lane < LANES; lane++) {
      const verdict = known[lane] ? null : engine.verdict(lane);
      if (verdict) {
        known[lane] = true;
        verdicts.push({ lane, ...verdict });
      }
    }
    if (verdicts.length || performance.now() - sent > 30) send(false);
    yield;
  }
  send(true);
}

// The first column under many motions, a lane each: the outcome of every cell as it comes.
function* map({ id, column, cells }) {
  engine.load(column);
  const inLane = new Array(LANES).fill(-1);
  let next = 0;
  const fill = (lane) => {
    inLane[lane] = next < cells.length ? next++ : -1;
    if (inLane[lane] < 0) return;
    engine.refill(lane);
    engine.begin(lane, engine.place(motionOf(engine.data, cells[inLane[lane]]), lane, LANES), 0);
  };
  for (let lane = 0; lane < LANES; lane++) {
    fill(lane);
    yield;
  }
  while (engine.running()) {
    engine.advance(8);
    for (let lane = 0; lane < LANES; lane++) {
      if (inLane[lane] < 0) continue;
      const verdict = engine.verdict(lane);
      if (!verdict) continue;
      postMessage({ id, kind: "cell", cell: inLane[lane], ...verdict });
      fill(lane);
    }
    yield;
  }
  postMessage({ id, kind: "map", over: true });
}
