// What moves in report.html: V on the deformed sheet over time, and curves over the pictures of them.
"use strict";

(() => {
  const decode = (text) => Uint8Array.from(atob(text.trim()), (letter) => letter.charCodeAt(0));
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const colours = decode(document.getElementById("colours").textContent);

  // --- Curves -------------------------------------------------------------------------------------

  const axisText = (axis) => (axis.unit ? `${axis.label} (${axis.unit})` : axis.label);

  const standsAlone = (s) => s.mark === "points" || s.mark === "rings";

  // uPlot reads a series from left to right; a path that turns back stays a picture.
  const readable = (plot) => plot.series.every((s) => standsAlone(s) ||
    s.x.every((x, n) => x !== null && (n === 0 || x >= s.x[n - 1])));

  const sorted = (s) => {
    const order = s.x.map((_, n) => n).filter((n) => s.x[n] !== null).sort((a, b) => s.x[a] - s.x[b]);
    const error = order.map((n) => s.error[n] ?? null);
    return { x: order.map((n) => s.x[n]), y: order.map((n) => s.y[n]), error };
  };

  // Points that share their x with another one would hide it: uPlot has one value at an x.
  const apart = ({ x, y, error }) => {
    const shifted = x.slice();
    for (let n = 1; n < x.length; ++n) {
      if (shifted[n] <= shifted[n - 1]) shifted[n] = shifted[n - 1] + 1e-9 * Math.max(1, Math.abs(shifted[n - 1]));
    }
    return { x: shifted, y, error };
  };

  const errorBars = (tables) => (u) => {
    const draw = u.ctx;
    draw.save();
    draw.lineWidth = devicePixelRatio;
    tables.forEach(({ x, y, error }, n) => {
      if (!u.series[n + 1].show) return;
      draw.strokeStyle = u.series[n + 1].stroke();
      draw.beginPath();
      error.forEach((half, k) => {
        if (!(half > 0) || y[k] === null) return;
        const at = u.valToPos(x[k], "x", true);
        draw.moveTo(at, u.valToPos(y[k] - half, "y", true));
        draw.lineTo(at, u.valToPos(y[k] + half, "y", true));
      });
      draw.stroke();
    });
    draw.restore();
  };

  const guideLines = (plot) => (u) => {
    const draw = u.ctx;
    draw.save();
    draw.strokeStyle = colour("--faint");
    draw.lineWidth = devicePixelRatio;
    draw.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
    for (const y of plot.guides) {
      const at = u.valToPos(y, "y", true);
      draw.beginPath();
      draw.moveTo(u.bbox.left, at);
      draw.lineTo(u.bbox.left + u.bbox.width, at);
      draw.stroke();
    }
    draw.restore();
  };

  const range = (axis, space) => (u, low, high) => {
    if (low === null || high === null) return [axis.min ?? 0, axis.max ?? 1];
    const length = high > low ? high - low : Math.abs(high) || 1;
    return [axis.min ?? low - space * length, axis.max ?? high + space * length];
  };

  const options = (plot, tables, width) => {
    const ink = colour("--ink"), line = colour("--line");
    const axis = (of) => ({
      label: axisText(of), stroke: ink, font: "12px system-ui, sans-serif", labelFont: "13px system-ui, sans-serif",
      grid: { stroke: line, width: 0.5 }, ticks: { stroke: line, size: 5 }, labelSize: 22,
    });
    const paths = { steps: uPlot.paths.stepped({ align: 1 }), bars: uPlot.paths.bars({ size: [1] }) };
    const lines = plot.series.every((s) => s.mark === "line" || s.mark === "steps");
    return {
      title: plot.title,
      width,
      height: Math.round(Math.min(340, Math.max(240, 0.62 * width))),
      scales: { x: { time: false, range: range(plot.x, lines ? 0 : 0.04) }, y: { range: range(plot.y, 0.05) } },
      axes: [axis(plot.x), { ...axis(plot.y), size: 62 }],
      cursor: { points: { size: 6 }, sync: plot.x.label === "time" ? { key: "time" } : undefined },
      hooks: { draw: [errorBars(tables), guideLines(plot)] },
      series: [{ label: axisText(plot.x), value: (u, v) => (v === null ? "–" : v.toPrecision(4)) },
        ...plot.series.map((s) => ({
          label: s.name || plot.y.label,
          // Black is the ink of the page.
          stroke: s.colour === "#000000" ? ink : s.colour,
          fill: s.mark === "bars" ? s.colour + "80" : undefined,
          width: standsAlone(s) ? 0 : 1.5,
          dash: s.dashed ? [6, 4] : undefined,
          paths: standsAlone(s) ? () => null : paths[s.mark],
          points: s.mark === "rings" ? { show: true, size: 6, width: 1, fill: "transparent" } :
            { show: s.mark.endsWith("points"), size: 5, fill: s.colour === "#000000" ? ink : s.colour },
          spanGaps: false,
          value: (u, v) => (v === null || v === undefined ? "–" : v.toPrecision(4)),
        }))],
    };
  };

  const drawCurves = (figure) => {
    const plot = JSON.parse(figure.querySelector("script").textContent);
    if (typeof uPlot === "undefined" || plot.equal_scales || !readable(plot)) return;
    const tables = plot.series.map((s) => apart(sorted(s)));
    const data = uPlot.join(tables.map(({ x, y }) => [x, y]));
    let chart = null;
    const draw = () => {
      chart?.destroy();
      chart = new uPlot(options(plot, tables, figure.clientWidth), data, figure);
      figure.append(figure.querySelector("figcaption"));
    };
    figure.classList.add("drawn");
    draw();
    let width = figure.clientWidth;
    new ResizeObserver(() => {
      if (figure.clientWidth === width || figure.clientWidth === 0) return;
      width = figure.clientWidth;
      chart.setSize({ width, height: chart.height });
    }).observe(figure);
    dark.addEventListener("change", draw);
  };

  // --- The sheet ----------------------------------------------------------------------------------

  const tail = 60;  // t.u. of the path behind a tip
  const picturesPerSecond = 24;

  class Sheet {
    constructor(figure) {
      const [facts, V, nodes] = figure.querySelectorAll("script");
      Object.assign(this, JSON.parse(facts.textContent));
      this.V = decode(V.textContent);
      this.nodes = new Float32Array(decode(nodes.textContent).buffer);
      this.figure = figure;
      this.canvas = figure.querySelector("canvas");
      this.slider = figure.querySelector(".time");
      this.output = figure.querySelector("output");
      this.button = figure.querySelector(".play");
      this.context = this.canvas.getContext("2d");
      const [low1, low2, high1, high2] = this.extent;
      const margin = 10, size = 720;
      this.scale = (size - 2 * margin) / Math.max(high1 - low1, high2 - low2);
      this.canvas.width = Math.ceil(this.scale * (high1 - low1) + 2 * margin);
      this.canvas.height = Math.ceil(this.scale * (high2 - low2) + 2 * margin);
      this.toX = (x1) => margin + this.scale * (x1 - low1);
      this.toY = (x2) => margin + this.scale * (high2 - x2);
      this.image = this.context.createImageData(this.canvas.width, this.canvas.height);
      this.playing = false;

      this.slider.addEventListener("input", () => this.draw());
      this.button.addEventListener("click", () => this.play(!this.playing));
      for (const box of figure.querySelectorAll("input[type=checkbox]")) box.addEventListener("change", () => this.draw());
      this.draw();
    }

    // Corner pixels of element (I, J) of frame n.
    node(n, I, J) {
      const width = this.element_columns + 1, count = width * (this.element_rows + 1);
      // A rigid sheet has one frame of nodes.
      const frame = this.nodes.length === 2 * count ? 0 : n;
      const at = 2 * (frame * count + I * width + J);
      return [this.toX(this.nodes[at]), this.toY(this.nodes[at + 1])];
    }

    // Pixel of a point of the material.
    place(n, X1, X2) {
      const u = Math.min(Math.max(X1 / this.length[0], 0), 1) * this.element_columns;
      const v = Math.min(Math.max(X2 / this.length[1], 0), 1) * this.element_rows;
      const J = Math.min(Math.floor(u), this.element_columns - 1), I = Math.min(Math.floor(v), this.element_rows - 1);
      const a = u - J, b = v - I;
      const [p, q, r, s] = [this.node(n, I, J), this.node(n, I, J + 1), this.node(n, I + 1, J), this.node(n, I + 1, J + 1)];
      return [0, 1].map((c) => (1 - b) * ((1 - a) * p[c] + a * q[c]) + b * ((1 - a) * r[c] + a * s[c]));
    }

    // The pixels of an element: the inverse of its bilinear map at each of them.
    fillElement(n, I, J) {
      const [x0, y0] = this.node(n, I, J), [x1, y1] = this.node(n, I, J + 1);
      const [x2, y2] = this.node(n, I + 1, J), [x3, y3] = this.node(n, I + 1, J + 1);
      const ax = x1 - x0, ay = y1 - y0, bx = x2 - x0, by = y2 - y0, tx = x0 - x1 - x2 + x3, ty = y0 - y1 - y2 + y3;
      const width = this.canvas.width, pixels = this.image.data, V = this.V;
      const first = n * this.rows * this.columns;
      const perElementX = (this.columns - 1) / this.element_columns, perElementY = (this.rows - 1) / this.element_rows;
      const left = Math.max(0, Math.floor(Math.min(x0, x1, x2, x3))), right = Math.min(width - 1, Math.ceil(Math.max(x0, x1, x2, x3)));
      const top = Math.max(0, Math.floor(Math.min(y0, y1, y2, y3)));
      const bottom = Math.min(this.canvas.height - 1, Math.ceil(Math.max(y0, y1, y2, y3)));
      const edge = 1e-6, a = tx * by - ty * bx, constant = ax * by - ay * bx;
      for (let y = top; y <= bottom; ++y) {
        for (let x = left; x <= right; ++x) {
          const dx = x - x0, dy = y - y0;
          // a eta^2 + b eta + c = 0; the root that stays finite for a parallelogram.
          const b = constant + dx * ty - dy * tx, c = dx * ay - dy * ax;
          const root = b * b - 4 * a * c;
          if (root < 0) continue;
          const eta = c / (-0.5 * (b + Math.sign(b || 1) * Math.sqrt(root)));
          if (!(eta >= -edge && eta <= 1 + edge)) continue;
          const ex = ax + tx * eta, ey = ay + ty * eta;
          const xi = Math.abs(ex) > Math.abs(ey) ? (dx - bx * eta) / ex : (dy - by * eta) / ey;
          if (!(xi >= -edge && xi <= 1 + edge)) continue;
          const column = Math.max(0, Math.min((J + xi) * perElementX, this.columns - 1.0001));
          const row = Math.max(0, Math.min((I + eta) * perElementY, this.rows - 1.0001));
          const j = column | 0, i = row | 0, u = column - j, v = row - i, at = first + i * this.columns + j;
          const value = (1 - v) * ((1 - u) * V[at] + u * V[at + 1]) +
            v * ((1 - u) * V[at + this.columns] + u * V[at + this.columns + 1]);
          const level = 3 * Math.round(value), pixel = 4 * (y * width + x);
          pixels[pixel] = colours[level];
          pixels[pixel + 1] = colours[level + 1];
          pixels[pixel + 2] = colours[level + 2];
          pixels[pixel + 3] = 255;
        }
      }
    }

    drawLines(n) {
      const draw = this.context;
      const line = (from, to) => { draw.moveTo(...from); draw.lineTo(...to); };
      const net = (inner) => {
        draw.beginPath();
        for (let I = 0; I <= this.element_rows; ++I) {
          for (let J = 0; J <= this.element_columns; ++J) {
            const edgeRow = I % this.element_rows === 0, edgeColumn = J % this.element_columns === 0;
            if (J < this.element_columns && edgeRow !== inner) line(this.node(n, I, J), this.node(n, I, J + 1));
            if (I < this.element_rows && edgeColumn !== inner) line(this.node(n, I, J), this.node(n, I + 1, J));
          }
        }
        draw.stroke();
      };
      draw.lineWidth = 1;
      draw.strokeStyle = "rgb(128 128 128 / 60%)";
      net(true);
      draw.lineWidth = 2;
      draw.strokeStyle = "#1e1e1e";
      net(false);
    }

    drawTips(n) {
      if (!this.tips) return;
      const draw = this.context, t = this.times[n], { tips } = this;
      const paths = new Map();
      for (let k = 0; k < tips.t.length; ++k) {
        if (tips.t[k] > t + 1e-6 || tips.t[k] < t - tail) continue;
        const of = tips.trajectory ? tips.trajectory[k] : k;
        if (!paths.has(of)) paths.set(of, []);
        paths.get(of).push(k);
      }
      // How old a look at the tips may be and still be that of this frame.
      const step = n > 0 ? t - this.times[n - 1] : 1;
      for (const path of paths.values()) {
        const last = path.at(-1), hue = tips.charge[last] > 0 ? "#d55e00" : "#e69f00";
        draw.strokeStyle = draw.fillStyle = hue;
        draw.lineWidth = 2;
        draw.beginPath();
        for (const k of path) draw.lineTo(...this.place(n, tips.x[k], tips.y[k]));
        draw.stroke();
        if (tips.t[last] < t - Math.min(step, 1)) continue;
        draw.beginPath();
        draw.arc(...this.place(n, tips.x[last], tips.y[last]), 6, 0, 2 * Math.PI);
        draw.fill();
        draw.strokeStyle = "#fff";
        draw.lineWidth = 1.5;
        draw.stroke();
      }
    }

    draw() {
      const n = Number(this.slider.value), t = this.times[n];
      this.image.data.fill(255);
      for (let I = 0; I < this.element_rows; ++I) for (let J = 0; J < this.element_columns; ++J) this.fillElement(n, I, J);
      this.context.putImageData(this.image, 0, 0);
      const shown = (name) => this.figure.querySelector(name).checked;
      if (shown(".lines")) this.drawLines(n);
      if (shown(".tips")) this.drawTips(n);
      const seconds = `${(1e-3 * this.ms_per_tu * t).toFixed(3)} s`;
      this.output.textContent = `t = ${seconds} (${Number(t.toFixed(2))} t.u.)`;
      this.slider.setAttribute("aria-valuetext", seconds);
    }

    play(on) {
      this.playing = on;
      this.button.textContent = on ? "❚❚" : "▶";
      this.button.setAttribute("aria-label", on ? "Pause" : "Play");
      if (!on) return;
      let shown = 0;
      const step = (now) => {
        if (!this.playing) return;
        if (now - shown >= 1000 / picturesPerSecond) {
          shown = now;
          this.slider.value = (Number(this.slider.value) + 1) % this.times.length;
          this.draw();
        }
        requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }
  }

  document.querySelectorAll("figure.curves").forEach(drawCurves);
  document.querySelectorAll("figure.sheet").forEach((figure) => new Sheet(figure));
})();
