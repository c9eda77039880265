// SPDX-License-Identifier: BSD-3-Clause
//
// The screenshot: what the canvas shows, with title, time and legend written on it, as a PNG.
import { css, ofPart, ofShare } from './colors.js';
import { ends } from './time.js';

const FONT = 'system-ui, "Segoe UI", Roboto, "Liberation Sans", sans-serif';

function drawLegend(context, source, height, ratio, text, soft) {
  const left = 16 * ratio;
  // As wide as the legend of the page, which the labels keep clear of.
  const perRow = Math.max(2, Math.floor((document.getElementById('legend').offsetWidth - 4) / 30));
  const parts = source.kind === 'parts' ? Math.min(8, source.count) : 0;
  let y = height - (44 + 15 * Math.max(0, Math.ceil(parts / perRow) - 1)) * ratio;
  context.fillStyle = text;
  context.font = `600 ${12 * ratio}px ${FONT}`;
  context.fillText(source.name + (source.unit ? ` (${source.unit})` : ''), left, y);
  y += 8 * ratio;
  context.font = `${12 * ratio}px ${FONT}`;
  if (source.kind === 'parts') {
    for (let i = 0; i < parts; ++i) {
      const x = left + 30 * (i % perRow) * ratio;
      const top = y + 15 * Math.floor(i / perRow) * ratio;
      context.fillStyle = css(ofPart(i));
      context.fillRect(x, top, 10 * ratio, 10 * ratio);
      context.fillStyle = soft;
      context.fillText(String(i + 1), x + 14 * ratio, top + 9.5 * ratio);
    }
    return;
  }
  const width = Math.min(200, document.getElementById('legend').offsetWidth - 16) * ratio;
  const gradient = context.createLinearGradient(left, 0, left + width, 0);
  for (let i = 0; i <= 10; ++i) gradient.addColorStop(i / 10, css(ofShare(i / 10)));
  context.fillStyle = gradient;
  context.fillRect(left, y, width, 9 * ratio);
  context.fillStyle = soft;
  const write = ends(source.lowest, source.highest);
  context.fillText(write(source.lowest), left, y + 23 * ratio);
  const last = write(source.highest);
  context.fillText(last, left + width - context.measureText(last).width, y + 23 * ratio);
}

/** The labels of the axes where they stand, with a rim of the ground. */
function drawLabels(context, labels, ratio, ground, text) {
  context.font = `${11 * ratio}px ${FONT}`;
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  context.lineWidth = 4 * ratio;
  context.strokeStyle = ground;
  context.fillStyle = text;
  for (const { element, place } of labels.all.flat()) {
    if (!place) continue;
    context.save();
    context.translate(place.x * ratio, place.y * ratio);
    if (place.isUpright) context.rotate(-Math.PI / 2);
    context.strokeText(element.innerText, 0, 0);
    context.fillText(element.innerText, 0, 0);
    context.restore();
  }
}

/** The picture as a Blob. */
export function takePicture({ stage, current, description, timeline, format, t }) {
  stage.render(); // in the same turn as the copy: what was drawn before may be gone
  const source = stage.canvas;
  const canvas = document.createElement('canvas');
  canvas.width = source.width;
  canvas.height = source.height;
  const ratio = source.width / source.clientWidth;
  const context = canvas.getContext('2d');
  context.drawImage(source, 0, 0);
  const style = getComputedStyle(document.documentElement);
  const [text, soft] = ['--text', '--soft'].map((name) => style.getPropertyValue(name).trim());
  drawLabels(context, stage.axisLabels, ratio, style.getPropertyValue('--ground').trim(), text);
  context.textAlign = 'left';
  context.textBaseline = 'alphabetic';
  context.fillStyle = text;
  context.font = `650 ${15 * ratio}px ${FONT}`;
  context.fillText(description.title, 16 * ratio, 26 * ratio);
  if (timeline) {
    context.fillStyle = soft;
    context.font = `${13 * ratio}px ${FONT}`;
    context.fillText([format.text(t), format.meaning(t)].filter(Boolean).join(' · '), 16 * ratio, 46 * ratio);
  }
  if (current.source && current.source.kind !== 'plain') drawLegend(context, current.source, canvas.height, ratio, text, soft);
  return new Promise((done) => canvas.toBlob(done, 'image/png'));
}

export async function savePicture(app) {
  const blob = await takePicture(app);
  const link = document.createElement('a');
  const name = app.description.title.replace(/[^\p{L}\p{N}.-]+/gu, '_') || 'tegl';
  link.download = `${name}${app.timeline ? `_${app.format.value(app.t)}` : ''}.png`;
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  return blob;
}
