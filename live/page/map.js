// The map: how fast along, how strong upward; a cell for each run.

class Verdicts {
  constructor(canvas, chosen) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.across = [];
    this.up = [];
    this.cells = [];
    this.at = [0, 0];
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.addEventListener("click", (event) => {
      const { left, top } = canvas.getBoundingClientRect(), box = this.box(1);
      const i = Math.floor((event.clientX - left - box.left) / box.wide), j = Math.floor((box.bottom - event.clientY + top) / box.high);
      if (i >= 0 && j >= 0 && i < this.across.length && j < this.up.length) {
        this.at = [i, j];
        chosen(i, j);
      }
    });
    canvas.addEventListener("keydown", (event) => {
      const move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (move) {
        this.at = [
          Math.min(Math.max(this.at[0] + move[0], 0), this.across.length - 1),
          Math.min(Math.max(this.at[1] + move[1], 0), this.up.length - 1),
        ];
        this.describe(...this.at);
      } else if (event.key === "Enter" || event.key === " ") chosen(...this.at);
      else return;
      event.preventDefault();
      this.draw();
    });
    canvas.addEventListener("focus", () => this.draw());
    canvas.addEventListener("blur", () => this.draw());
    this.describe = () => {};
  }

  begin(across, up, labels, cells = new Array(across.length * up.length).fill(null)) {
    Object.assign(this, { across, up, labels, cells });
    this.at = [Math.min(this.at[0], across.length - 1), Math.min(this.at[1], up.length - 1)];
    this.draw();
  }

  set(i, j, outcome) {
    this.cells[j * this.across.length + i] = outcome;
    this.draw();
  }

  of(i, j) {
    return this.cells[j * this.across.length + i];
  }

  box(ratio) {
    const w = this.canvas.clientWidth * ratio, h = this.canvas.clientHeight * ratio;
    const left = 62 * ratio, bottom = h - 34 * ratio, top = 6 * ratio;
    return { left, bottom, wide: (w - left - 4 * ratio) / Math.max(1, this.across.length), high: (bottom - top) / Math.max(1, this.up.length), w, h };
  }

  draw() {
    const { canvas, pen } = this, ratio = Math.min(devicePixelRatio || 1, 2), box = this.box(ratio);
    canvas.width = Math.round(box.w);
    canvas.height = Math.round(box.h);
    if (!this.across.length) return;
    const gap = ratio;
    for (let j = 0; j < this.up.length; j++)
      for (let i = 0; i < this.across.length; i++) {
        const outcome = this.of(i, j);
        pen.fillStyle = outcome === null ? "#ebe4d5" : outcome === FELL ? "#a63a22" : outcome === 4 ? "#8a8273" : "#9cc3b1";
        pen.fillRect(box.left + i * box.wide, box.bottom - (j + 1) * box.high, box.wide - gap, box.high - gap);
      }
    pen.fillStyle = "#5d5547";
    pen.font = `${11.5 * ratio}px system-ui, sans-serif`;
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (let j = 0; j < this.up.length; j++)
      if (j % 3 === 0) pen.fillText(`${+this.up[j].toFixed(2)} g`, box.left - 5 * ratio, box.bottom - (j + 0.5) * box.high);
    pen.textBaseline = "top";
    pen.textAlign = "center";
    const { ticks, title } = this.labels;
    ticks.forEach((text, i) => text && pen.fillText(text, box.left + (i + 0.5) * box.wide, box.bottom + 4 * ratio));
    pen.fillText(title, box.left + (this.across.length * box.wide) / 2, box.bottom + 19 * ratio);
    pen.save();
    pen.translate(2 * ratio, box.bottom - (this.up.length * box.high) / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText("how strong", 0, 0);
    pen.restore();
    if (this.mark) {
      pen.strokeStyle = "#26221c";
      pen.lineWidth = 2 * ratio;
      pen.strokeRect(box.left + this.mark[0] * box.wide, box.bottom - (this.mark[1] + 1) * box.high, box.wide - gap, box.high - gap);
    }
    if (document.activeElement === canvas) {
      pen.strokeStyle = "#b3541e";
      pen.lineWidth = 3 * ratio;
      pen.strokeRect(box.left + this.at[0] * box.wide, box.bottom - (this.at[1] + 1) * box.high, box.wide - gap, box.high - gap);
    }
  }
}
