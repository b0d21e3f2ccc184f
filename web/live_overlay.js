// What lies over the points: the plan of what was seen, the way, the gaps, the marks, and me.

const SEEN = { FREE: 1, POOR: 2, WELL: 3 };

const PX = 4;
const INKS = { [SEEN.FREE]: () => 0.12, [SEEN.POOR]: (i, j) => ((i + j) % PX < 2 ? 0.95 : 0.3), [SEEN.WELL]: () => 0.4 };

/** The plan as a picture of 4 x 4 pixels a cell, x to the right and y up; what was seen poorly is hatched. */
export async function planPicture(plan, [poor, well]) {
  const bytes = Uint8Array.from(atob(plan.seen), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const seen = new Uint8Array(await new Response(stream).arrayBuffer());
  const [along, across] = plan.shape;
  const picture = new ImageData(PX * along, PX * across);
  const colors = { [SEEN.FREE]: rgb(well), [SEEN.POOR]: rgb(poor), [SEEN.WELL]: rgb(well) };
  for (let i = 0; i < along; i++)
    for (let j = 0; j < across; j++) {
      const kind = seen[i * across + j];
      if (kind in colors) paintCell(picture, PX * i, PX * (across - 1 - j), colors[kind], INKS[kind]);
    }
  return { bitmap: await createImageBitmap(picture), ...plan };
}

function paintCell(picture, left, top, color, ink) {
  for (let y = top; y < top + PX; y++)
    for (let x = left; x < left + PX; x++) picture.data.set([...color, 255 * ink(x, y)], 4 * (y * picture.width + x));
}

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

export function drawOverlay(context, { width, height, ratio, foot }, camera, scene, styles) {
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.translate(width / 2, height / 2);
  const floor = scene.me?.p[2] ?? 0;
  if (scene.showPlan && scene.plan && camera.above) drawPlan(context, camera, scene.plan);
  drawPath(context, camera, scene.path, styles);
  if (scene.showPlan) scene.gaps.forEach((gap, k) => drawGap(context, camera, [...gap.p, floor], gap, styles, k === scene.chosen));
  for (const mark of scene.marks) drawMark(context, camera, mark, styles);
  if (scene.me) drawMe(context, camera, scene.me, styles);
  drawScale(context, camera, { x: 14 - width / 2, y: foot - 12 - height / 2 }, styles);
}

function drawPlan(context, camera, plan) {
  const [i, j] = plan.first_cell;
  const [along, across] = plan.shape;
  const [x, y] = camera.project([i * plan.cell_m, (j + across) * plan.cell_m, camera.target[2]]);
  const cell = plan.cell_m * camera.pxPerM;
  context.imageSmoothingEnabled = false;
  context.drawImage(plan.bitmap, x, y, along * cell, across * cell);
}

function drawPath(context, camera, path, styles) {
  if (path.length < 2) return;
  context.beginPath();
  for (const place of path) context.lineTo(...camera.project(place));
  context.lineWidth = 3;
  context.lineJoin = "round";
  context.strokeStyle = styles.path;
  context.stroke();
  const [x, y] = camera.project(path[0]);
  label(context, "start", x, y, styles.path, styles.sky);
}

function drawGap(context, camera, place, gap, styles, chosen) {
  const [x, y] = camera.project(place);
  const r = Math.max(10, (gap.width_m * camera.pxPerM) / 2);
  context.beginPath();
  context.arc(x, y, Math.min(r, 60), 0, 2 * Math.PI);
  context.setLineDash(chosen ? [] : [5, 4]);
  context.lineWidth = chosen ? 5 : 2;
  context.strokeStyle = styles.gap;
  context.stroke();
  context.setLineDash([]);
  label(context, "?", x, y, styles.gap, styles.sky);
}

function drawMark(context, camera, mark, styles) {
  const [x, y] = camera.project(mark.p);
  context.fillStyle = styles.accent;
  context.beginPath();
  context.arc(x, y, 6, 0, 2 * Math.PI);
  context.fill();
  if (mark.text) label(context, mark.text, x + 10, y, styles.ink, styles.sky, "left");
}

function drawMe(context, camera, me, styles) {
  const [x, y] = camera.project(me.p);
  const [fx, fy] = camera.project([me.p[0] + Math.cos(me.yaw), me.p[1] + Math.sin(me.yaw), me.p[2]]);
  const turn = Math.atan2(fy - y, fx - x);
  context.save();
  context.translate(x, y);
  context.rotate(turn);
  context.beginPath();
  context.moveTo(16, 0);
  context.lineTo(-10, 10);
  context.lineTo(-5, 0);
  context.lineTo(-10, -10);
  context.closePath();
  context.fillStyle = me.lost ? styles.gap : styles.me;
  context.strokeStyle = styles.sky;
  context.lineWidth = 2;
  context.fill();
  context.stroke();
  context.restore();
}

function drawScale(context, camera, { x, y }, styles) {
  const meters = [0.5, 1, 2, 5, 10, 20, 50, 100].find((m) => m * camera.pxPerM >= 60) ?? 200;
  context.strokeStyle = styles.ink;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(x, y - 5);
  context.lineTo(x, y);
  context.lineTo(x + meters * camera.pxPerM, y);
  context.lineTo(x + meters * camera.pxPerM, y - 5);
  context.stroke();
  label(context, `${meters} m`, x + 4, y - 12, styles.ink, styles.sky, "left");
}

function label(context, text, x, y, color, around, align = "center") {
  context.font = "600 14px system-ui, sans-serif";
  context.textAlign = align;
  context.textBaseline = "middle";
  context.lineWidth = 4;
  context.lineJoin = "round";
  context.strokeStyle = around;
  context.strokeText(text, x, y);
  context.fillStyle = color;
  context.fillText(text, x, y);
}
