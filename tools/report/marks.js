'use strict';
// What Chart.js does not draw by itself: intervals, names beside points, logarithmic axes that can show a zero.

// Draws each point's intervals {xLow, xHigh, yLow, yHigh}, those that it has.
const intervalMarks = {
  id: 'intervalMarks',
  beforeDatasetsDraw(chart) {
    const {ctx, scales: {x, y}} = chart;
    ctx.save();
    chart.data.datasets.forEach((dataset, i) => {
      if (!chart.isDatasetVisible(i)) return;
      ctx.strokeStyle = dataset.borderColor;
      dataset.data.forEach((point) => {
        ctx.globalAlpha = point.dim ? 0.25 : 0.8;
        ctx.beginPath();
        if (point.xHigh > point.xLow) {
          ctx.moveTo(x.getPixelForValue(point.xLow), y.getPixelForValue(point.y));
          ctx.lineTo(x.getPixelForValue(point.xHigh), y.getPixelForValue(point.y));
        }
        if (point.yHigh > point.yLow) {
          ctx.moveTo(x.getPixelForValue(point.x), y.getPixelForValue(Math.max(point.yLow, y.min)));
          ctx.lineTo(x.getPixelForValue(point.x), y.getPixelForValue(point.yHigh));
        }
        ctx.stroke();
      });
    });
    ctx.restore();
  },
};

// A vertical line at chart.options.budget milliseconds.
const budgetLine = {
  id: 'budgetLine',
  beforeDatasetsDraw(chart) {
    const {ctx, chartArea, options: {budget}, scales: {x}} = chart;
    if (!(budget >= x.min && budget <= x.max)) return;
    const at = x.getPixelForValue(budget);
    ctx.save();
    ctx.fillStyle = 'rgba(11, 98, 176, 0.07)';
    ctx.fillRect(chartArea.left, chartArea.top, at - chartArea.left, chartArea.height);
    ctx.strokeStyle = '#0b62b0';
    ctx.beginPath();
    ctx.moveTo(at, chartArea.top);
    ctx.lineTo(at, chartArea.bottom);
    ctx.stroke();
    ctx.restore();
  },
};

// "pcf kernel=15 shadow_map=512" in lines of at most `length` characters, where it can be broken.
function lines(text, length) {
  const made = [];
  for (const word of text.split(' '))
    if (made.length && made[made.length - 1].length + 1 + word.length <= length) made[made.length - 1] += ` ${word}`;
    else made.push(word);
  return made;
}

// Writes `point.name` beside points, where there is room and no other name.
const pointNames = {
  id: 'pointNames',
  afterDatasetsDraw(chart) {
    const {ctx, chartArea, scales: {x, y}} = chart;
    if (chartArea.width < 400) return;
    const taken = [];
    ctx.save();
    ctx.font = '11px system-ui, sans-serif';
    ctx.textBaseline = 'middle';
    chart.data.datasets.forEach((dataset, i) => {
      if (!chart.isDatasetVisible(i)) return;
      dataset.data.filter((point) => point.name).forEach((point) => {
        const px = x.getPixelForValue(point.x), py = y.getPixelForValue(point.y) - 10;
        const width = ctx.measureText(point.name).width;
        const left = px + width + 10 > chartArea.right ? px - width - 8 : px + 8;
        const covers = (box) => left < box[1] && left + width > box[0] && Math.abs(py - box[2]) < 11;
        if (taken.some(covers)) return;
        taken.push([left, left + width, py]);
        ctx.fillStyle = '#1c2330';
        ctx.fillText(point.name, left, py);
      });
    });
    ctx.restore();
  },
};

// Three significant digits.
function figure(value) {
  if (value === null || value === undefined) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(3)));
}

// Where zeros are drawn on a logarithmic axis: a third of the least positive value.
function floorOf(values) {
  const positive = values.filter((value) => value > 0);
  return positive.length ? Math.min(...positive) / 3 : 1e-6;
}

// {min, max}: the powers of ten, or twice or five times them, around positive numbers.
function roundLimits(low, high) {
  const steps = (number) => [1, 2, 5, 10].map((digit) => digit * 10 ** Math.floor(Math.log10(number)));
  return {min: steps(low).filter((step) => step <= low).pop(), max: steps(high).find((step) => step >= high)};
}

function logAxis(title) {
  return {
    type: 'logarithmic',
    title: {display: true, text: title},
    ticks: {
      maxRotation: 0,
      autoSkip: true,
      callback(value) {
        const leading = value / 10 ** Math.floor(Math.log10(value) + 1e-9), digit = Math.round(leading);
        if (Math.abs(leading - digit) > 1e-6) return null;  // the axis' end, which is no round number
        const narrow = this.max < 10 * this.min;  // less than a decade: every digit
        return narrow || [1, 2, 5, 10].includes(digit) ? figure(value) : null;
      },
    },
  };
}

// One colour for each technique, the same all over the page.
function coloursOf(names) {
  const goldenAngle = 137.508;  // degrees: neighbours in the list lie far apart on the circle
  return Object.fromEntries(names.map(
      (name, i) => [name, `hsl(${(210 + i * goldenAngle) % 360} 70% ${i % 2 ? 32 : 44}%)`]));
}

function element(tag, text, className) {
  const made = document.createElement(tag);
  if (text !== undefined && text !== null) made.textContent = text;
  if (className) made.className = className;
  return made;
}

// `rows` of cells; `textColumns` are left-aligned; `classes`: of each row.
function fillTable(table, head, rows, textColumns = [], classes = []) {
  const line = (cells, tag) => {
    const row = element('tr');
    cells.forEach((cell, i) => row.append(element(tag, cell, textColumns.includes(i) ? 'text' : '')));
    return row;
  };
  const body = rows.map((cells) => line(cells, 'td'));
  body.forEach((row, i) => { row.className = classes[i] || ''; });
  table.replaceChildren(line(head, 'th'), ...body);
}

function fillSelect(select, entries, chosen) {
  select.replaceChildren(...entries.map(([value, text]) => {
    const option = element('option', text);
    option.value = value;
    return option;
  }));
  if (entries.some(([value]) => String(value) === String(chosen))) select.value = chosen;
}
