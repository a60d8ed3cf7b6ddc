// The page: a section for each place (scene, size, device), growth with parameters, what was left out.

class Report {
  constructor(report) {
    this.report = report;
    this.colours = coloursOf([...new Set(report.rows.map((row) => row.technique))]);
    this.passColours = coloursOf([...new Set(report.rows.flatMap((row) => row.passes.map((pass) => pass.type)))]);
    this.charts = [];  // of the places: {scatter, table}
    Chart.defaults.animation = false;
    Chart.defaults.maintainAspectRatio = false;
    Chart.defaults.font.family = 'system-ui, sans-serif';
    this.get = (id) => document.getElementById(id);
    const techniques = Object.keys(this.colours).length;
    this.get('summary').textContent = `${report.rows.length} measurements of ${techniques} techniques · ` +
        [...new Set(report.places.map((place) => place.device))].join(', ') + ` · gnomon ${report.gnomon}` +
        (report.failed.length ? ` · ${report.failed.length} failed` : '');
    fillSelect(this.get('metric'), report.metrics.map((metric) => [metric.name, metric.title]));
    this.get('metric').addEventListener('change', () => this.chooseMetric());
    this.get('time').addEventListener('change', () => this.chooseMetric());
    this.get('budget').addEventListener('input', () => this.chooseMetric());
    report.places.forEach((place, i) => this.addPlace(place, i));
    this.setUpSweeps();
    this.images = new ImageComparison(report, (place) => this.placeTitle(place));
    this.listLeftOut();
    this.listWarnings();
    this.listFailed();
    this.chooseMetric();
    window.addEventListener('beforeprint', () => Object.values(Chart.instances).forEach((chart) => chart.resize()));
  }

  get metric() { return this.get('metric').value; }
  get time() { return this.get('time').value; }  // the field of a row: ms or steady_ms
  get budget() { return Number(this.get('budget').value) || 0; }  // milliseconds; 0: any
  get metricTitle() {
    const found = this.report.metrics.find((metric) => metric.name === this.metric);
    return found ? found.title : 'error';
  }

  placeTitle(place) {
    const several = (key) => new Set(this.report.places.map((other) => other[key])).size > 1;
    return `${place.scene}, ${(place.size || []).join(' × ')}` +
        (place.frames ? `, ${place.frames} frames` : '') + (several('camera') ? `, camera ${place.camera}` : '') +
        (several('light_scale') ? `, lights × ${place.light_scale}` : '') +
        (several('samples') ? `, ${place.samples} reference samples` : '') + (several('device') ? `, ${place.device}` : '');
  }

  rowsOf(place) { return place.rows.map((id) => this.report.rows[id]); }

  addPlace(place, i) {
    const section = element('section');
    section.id = `place-${i}`;
    section.append(element('h2', this.placeTitle(place)));
    const link = element('a', this.placeTitle(place));
    link.href = `#place-${i}`;
    this.get('contents').append(link);
    const canvas = (title, height) => {
      const holder = element('div', null, 'chart'), made = element('canvas');
      if (height) holder.style.height = height;
      made.setAttribute('role', 'img');
      made.setAttribute('aria-label', title);
      holder.append(made);
      const figureBox = element('figure');
      figureBox.append(holder, element('figcaption', title));
      section.append(figureBox);
      return made;
    };
    const answer = element('p', null, 'answer');
    section.append(answer);
    const scatter = this.scatter(canvas('Each point is a technique with its settings; further left is quicker, further down more ' +
        'exact. The dashed line is the Pareto front; what it dominates is dimmed. Horizontal bars: 95 % intervals of the median ' +
        'time. Vertical bars: 95 % intervals of the error over the parts of the image, of a sequence the range over its frames. ' +
        'Diamond: the baseline. Triangle: an error of 0.'));
    const details = element('details');
    details.open = true;
    const box = element('div', null, 'scroll'), table = element('table');
    table.className = 'values';
    box.append(table);
    details.append(element('summary', 'Values, least error first'), box);
    section.append(details);
    const timed = this.rowsOf(place).filter((row) => row.passes.length);
    if (timed.length)
      this.passBars(canvas('Where the time goes: milliseconds by type of pass (medians, as they overlap in the frame); “rest” is ' +
          'recording, submission and waiting.', `${Math.max(10, 6 + (window.innerWidth < 700 ? 2.4 : 1.6) * timed.length)}rem`), timed);
    this.get('places').append(section);
    this.charts.push({place, scatter, table, answer});
  }

  scatter(canvas) {
    return new Chart(canvas, {
      type: 'scatter',
      data: {datasets: []},
      plugins: [budgetLine, intervalMarks, pointNames],
      options: {
        scales: {x: logAxis('milliseconds'), y: logAxis('error')},
        plugins: {
          legend: {position: 'bottom', labels: {usePointStyle: true, generateLabels: (chart) => this.legend(chart)}},
          tooltip: {callbacks: {label: (item) => this.tooltip(item.raw)}},
        },
      },
    });
  }

  // A technique's colour undimmed, whatever its first point looks like.
  legend(chart) {
    return chart.data.datasets.map((dataset, datasetIndex) => {
      const line = dataset.type === 'line';
      return {text: dataset.label, datasetIndex, hidden: !chart.isDatasetVisible(datasetIndex), lineWidth: line ? 1.5 : 0,
        fillStyle: dataset.borderColor, strokeStyle: dataset.borderColor, pointStyle: line ? 'line' : 'circle'};
    });
  }

  tooltip(point) {
    if (!point.row) return '';
    const {row} = point;
    const ms = row[this.time], error = row.errors[this.metric];
    const errors = error.high > error.low ? ` (${figure(error.low)} to ${figure(error.high)})` : '';
    return [row.label, `${figure(ms.median)} ms (${figure(ms.low)} to ${figure(ms.high)}, n = ${ms.n})`,
      `${this.metricTitle} ${figure(error.value)}${errors}`].concat(
        row.ratio ? [`${figure(row.ratio.median)} × the baseline's time`] : []);
  }

  chooseMetric() {
    const metric = this.report.metrics.find((entry) => entry.name === this.metric);
    this.get('definition').textContent = metric ? `${metric.definition} [${metric.unit}]; less is better` : '';
    this.get('time-note').textContent = this.time === 'ms' ?
        'Medians as measured. Rows that were measured while the machine was slow stand too far right.' :
        'The ratio to the baseline, which was measured in the same moments, times the baseline\'s median: rows measured while ' +
        'the machine was slow can be compared with the others.';
    this.charts.forEach((chart) => this.drawPlace(chart));
    this.drawSweeps();
  }

  // Which row to take for the time there is: the whole interval within it, as `gnomon pick` has it.
  answerOf(rows) {
    if (!rows.length) return 'No row has this metric.';
    const within = rows.filter((row) => !this.budget || row[this.time].high <= this.budget);
    const limit = this.budget ? ` within ${figure(this.budget)} ms` : '';
    if (!within.length) return `Nothing${limit}: the quickest takes ${figure(Math.min(...rows.map((row) => row[this.time].high)))} ms.`;
    const error = (row) => row.errors[this.metric].value, ms = (row) => row[this.time].median;
    const best = within.reduce((a, b) => error(b) < error(a) || (error(b) === error(a) && ms(b) < ms(a)) ? b : a);
    return `Least error${limit}: ${best.label}, ${this.metricTitle} ${figure(error(best))} in ${figure(ms(best))} ms.`;
  }

  drawPlace({place, scatter, table, answer}) {
    const rows = this.rowsOf(place).filter((row) => row.ms && row.errors[this.metric]);
    const fronts = this.time === 'ms' ? place.fronts : place.steady_fronts;
    const front = new Set(fronts[this.metric] || []);
    answer.textContent = this.answerOf(rows);
    scatter.options.budget = this.budget;
    const floor = floorOf(rows.map((row) => row.errors[this.metric].value));
    const pointOf = (row) => {
      const error = row.errors[this.metric];
      const named = front.has(row.id) || row.baseline;
      const ms = row[this.time];
      return {x: ms.median, y: Math.max(error.value, floor), xLow: ms.low, xHigh: ms.high, yLow: error.low,
        yHigh: error.high, row, dim: !front.has(row.id) && !row.baseline, name: named ? row.label : ''};
    };
    const onFront = (fronts[this.metric] || []).map((id) => pointOf(this.report.rows[id]));
    const datasets = Object.keys(this.colours).map((technique) => {
      const data = rows.filter((row) => row.technique === technique).map(pointOf);
      const colour = this.colours[technique];
      return {label: technique, data, borderColor: colour, showLine: false,
        backgroundColor: colour, pointBackgroundColor: data.map((p) => p.dim ? colour.replace(')', ' / 0.25)') : colour),
        pointBorderColor: data.map((p) => p.row.baseline ? '#000' : p.dim ? colour.replace(')', ' / 0.35)') : colour),
        pointRadius: data.map((p) => p.row.baseline ? 8 : 6), pointHoverRadius: 9,
        pointStyle: data.map((p) => p.row.baseline ? 'rectRot' : p.row.errors[this.metric].value > 0 ? 'circle' : 'triangle')};
    }).filter((dataset) => dataset.data.length);
    const line = onFront.map(({x, y}) => ({x, y}));
    datasets.push({label: 'Pareto front', type: 'line', data: line, borderColor: '#444', borderWidth: 1.5, stepped: 'before',
      pointRadius: 0, pointHitRadius: 0, pointStyle: 'line', borderDash: [5, 3]});
    scatter.data.datasets = datasets;
    scatter.options.scales.y.title.text = this.metricTitle;
    const shown = datasets.flatMap((dataset) => dataset.data), margin = 1.4;  // times, around what is shown
    const limit = (scale, low, high) => Object.assign(scale, shown.length ?
        {min: Math.min(...shown.map(low)) / margin, max: Math.max(...shown.map(high)) * margin} : {min: 1, max: 10});
    limit(scatter.options.scales.x, (p) => p.xLow ?? p.x, (p) => p.xHigh ?? p.x);
    limit(scatter.options.scales.y, (p) => p.yLow > 0 ? Math.min(p.yLow, p.y) : p.y, (p) => Math.max(p.yHigh ?? p.y, p.y));
    scatter.update();
    const sorted = [...rows].sort((a, b) => a.errors[this.metric].value - b.errors[this.metric].value || a[this.time].median - b[this.time].median);
    fillTable(table, ['technique', this.metricTitle, 'ms', '95 % interval of ms', 'n', '× baseline', 'MiB', 'Pareto'],
        sorted.map((row) => [row.label + (row.baseline ? ' (baseline)' : ''), figure(row.errors[this.metric].value),
          figure(row[this.time].median), `${figure(row[this.time].low)} to ${figure(row[this.time].high)}`, row.ms.n, row.ratio ? figure(row.ratio.median) : '–',
          row.peak_bytes ? figure(row.peak_bytes / 2 ** 20) : '–', front.has(row.id) ? 'front' : '']),
        [0], sorted.map((row) => front.has(row.id) ? 'front' : 'dominated'));
  }

  passBars(canvas, rows) {
    const types = [...new Set(rows.flatMap((row) => row.passes.map((pass) => pass.type)))];
    const sum = (row, type) => row.passes.filter((pass) => pass.type === type).reduce((all, pass) => all + pass.ms, 0);
    const sets = types.map((type) => ({label: type, data: rows.map((row) => sum(row, type)), backgroundColor: this.passColours[type]}));
    sets.push({label: 'rest', data: rows.map((row) => row.rest_ms), backgroundColor: '#d5dae1'});
    return new Chart(canvas, {
      type: 'bar',
      data: {labels: rows.map((row) => row.label), datasets: sets},
      options: {
        indexAxis: 'y',
        scales: {x: {stacked: true, title: {display: true, text: 'milliseconds'}}, y: {stacked: true, ticks: {autoSkip: false, callback: (i) => this.barName(rows[i].label, canvas)}}},
        plugins: {
          legend: {position: 'bottom'},
          tooltip: {callbacks: {label: (item) => `${item.dataset.label}: ${figure(item.raw)} ms`}, filter: (item) => item.raw > 0},
        },
      },
    });
  }

  // In several lines where the chart is narrow.
  barName(label, canvas) { return canvas.clientWidth < 600 ? lines(label, 22) : label; }

  setUpSweeps() {
    const {sweeps} = this.report;
    if (!sweeps.length) return;
    this.get('sweeps').hidden = false;
    const scenes = [...new Set(sweeps.map((sweep) => sweep.scene))];
    fillSelect(this.get('sweep-scene'), scenes.map((scene) => [scene, scene]));
    const chart = (id) => new Chart(this.get(id), {
      type: 'line',
      data: {datasets: []},
      plugins: [intervalMarks],
      options: {
        scales: {x: logAxis(''), y: logAxis('')},
        plugins: {
          legend: {position: 'bottom'},
          tooltip: {callbacks: {title: () => '', label: (item) => `${item.dataset.label}: ${figure(item.raw.shown)} at ${figure(item.raw.at)}`}},
        },
      },
    });
    this.sweepCharts = {ms: chart('sweep-ms'), error: chart('sweep-error')};
    this.get('sweep-scene').addEventListener('change', () => this.chooseScene());
    this.get('sweep-parameter').addEventListener('change', () => this.drawSweeps());
    this.chooseScene();
  }

  chooseScene() {
    const sweeps = this.report.sweeps.filter((sweep) => sweep.scene === this.get('sweep-scene').value);
    const count = (name) => sweeps.filter((sweep) => sweep.parameter === name).reduce((sum, sweep) => sum + sweep.x.length, 0);
    const names = [...new Set(sweeps.map((sweep) => sweep.parameter))].sort((a, b) => count(b) - count(a));
    fillSelect(this.get('sweep-parameter'), names.map((name) => [name, name.replace('_', ' ')]), this.get('sweep-parameter').value);
    this.drawSweeps();
  }

  drawSweeps() {
    if (!this.sweepCharts) return;
    const parameter = this.get('sweep-parameter').value, {rows} = this.report;
    const sweeps = this.report.sweeps.filter(
        (sweep) => sweep.scene === this.get('sweep-scene').value && sweep.parameter === parameter);
    const name = (sweep) => sweep.technique + (sweep.fixed ? ` (${sweep.fixed})` : '');
    const least = floorOf(sweeps.flatMap((sweep) => sweep.x));
    const draw = (chart, title, value, interval) => {
      const all = sweeps.flatMap((sweep) => sweep.rows.map((id) => value(rows[id])));
      const floor = floorOf(all.filter((number) => number !== undefined));
      chart.data.datasets = sweeps.map((sweep) => ({label: name(sweep), borderColor: this.colours[sweep.technique],
        backgroundColor: this.colours[sweep.technique], borderWidth: 2, pointRadius: 4,
        data: sweep.rows.map((id, i) => ({x: Math.max(sweep.x[i], least), at: sweep.x[i], y: Math.max(value(rows[id]), floor), shown: value(rows[id]),
              yLow: (interval(rows[id]) || {}).low, yHigh: (interval(rows[id]) || {}).high}))
            .filter((point) => point.shown !== undefined)}));
      const shown = chart.data.datasets.flatMap((dataset) => dataset.data);
      if (shown.length)
        Object.assign(chart.options.scales.y, roundLimits(
            Math.min(...shown.map((p) => p.yLow > 0 ? Math.min(p.yLow, p.y) : p.y)),
            Math.max(...shown.map((p) => Math.max(p.yHigh ?? p.y, p.y)))));
      chart.options.scales.x.title.text =
          parameter.replace('_', ' ') + (sweeps.some((sweep) => sweep.x.includes(0)) ? ` (0 at ${figure(least)})` : '');
      chart.options.scales.y.title.text = title;
      chart.update();
    };
    draw(this.sweepCharts.ms, 'milliseconds', (row) => row.ms ? row.ms.median : undefined, (row) => row.ms);
    draw(this.sweepCharts.error, this.metricTitle, (row) => (row.errors[this.metric] || {}).value,
        (row) => row.errors[this.metric]);
    this.get('sweep-error-caption').textContent = `Error (${this.metricTitle}), with its interval over the parts of the image`;
    const fit = (law) => law ? [law.exponent.toFixed(2), law.n > 2 ? law.r2.toFixed(3) : '–', law.n] : ['–', '–', '–'];
    fillTable(this.get('exponents'), ['technique', 'time: p', 'R²', 'points', `${this.metricTitle}: p`, 'R²', 'points'],
        sweeps.map((sweep) => [name(sweep), ...fit(sweep.ms), ...fit(sweep.errors[this.metric])]), [0]);
  }

  listLeftOut() {
    const by = new Map();  // what was left out of which technique and why -> where, and with which settings
    for (const row of this.report.rows)
      for (const {pass, part, reason} of row.left_out) {
        const key = JSON.stringify([row.technique, part ? `${pass}, ${part}` : pass, reason]);
        const found = by.get(key) || {places: new Set(), rows: 0};
        found.places.add(this.placeTitle(this.report.places[row.place]));
        ++found.rows;
        by.set(key, found);
      }
    if (!by.size) return;
    this.get('left-out').hidden = false;
    fillTable(this.get('left-out-table'), ['technique', 'pass', 'why', 'rows', 'scenes'],
        [...by].map(([key, found]) => [...JSON.parse(key), found.rows, [...found.places].join('; ')]), [0, 1, 2, 4]);
  }

  // Each sentence once, with who says it.
  listWarnings() {
    const by = new Map();
    for (const row of this.report.rows)
      for (const text of row.warnings)
        by.set(text, (by.get(text) || new Set()).add(`${this.report.places[row.place].scene}: ${row.technique}`));
    if (this.report.images_left_out)
      by.set(`${this.report.images_left_out} images were left out to keep this page small (--image-budget)`, new Set());
    if (!by.size) return;
    this.get('warnings').hidden = false;
    this.get('warning-list').append(...[...by].map(
        ([text, who]) => element('li', who.size ? `${text} (${[...who].join(', ')})` : text)));
  }

  listFailed() {
    if (!this.report.failed.length) return;
    this.get('failed').hidden = false;
    fillTable(this.get('failed-table'), ['scene', 'size', 'technique', 'why'],
        this.report.failed.map((row) => [row.scene, (row.size || []).join(' × '), row.label, row.status]), [0, 1, 2, 3]);
  }
}

const report = new Report(JSON.parse(document.getElementById('data').textContent));
