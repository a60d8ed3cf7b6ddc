// Two techniques' images under a slider, beside the reference: visibility, shaded image, false-colour error.

const pixelKinds = {
  error: {title: 'error, false colour', needs: ['visibility', 'reference'], reference: 'reference'},
  visibility: {title: 'visibility of the first light', needs: ['visibility'], reference: 'reference'},
  color: {title: 'shaded image', needs: ['color'], reference: 'reference_color'},
};

class ImageComparison {
  constructor(report, placeTitle) {
    this.report = report;
    this.placeTitle = placeTitle;
    this.decoded = new Map();
    this.turn = 0;  // of the latest drawing: earlier ones that end later are dropped
    this.get = (id) => document.getElementById(id);
    this.rows = report.rows.filter((row) => this.kindsOf(row).length > 0);
    if (!this.rows.length) return;
    this.get('images').hidden = false;
    const places = [...new Set(this.rows.map((row) => row.place))];
    fillSelect(this.get('image-place'), places.map((i) => [i, placeTitle(report.places[i])]));
    this.get('image-place').addEventListener('change', () => this.choosePlace());
    for (const id of ['image-kind', 'image-left', 'image-right'])
      this.get(id).addEventListener('change', () => this.draw());
    this.get('slider').addEventListener('input', () => this.place());
    this.get('image-fit').addEventListener('change', () => this.fit());
    this.get('slider-box').addEventListener('pointermove', (event) => this.read(event));
    this.choosePlace();
  }

  kindsOf(row) {
    const has = (name) => row.images[name] !== undefined;
    return Object.keys(pixelKinds).filter((kind) => pixelKinds[kind].needs.every(has));
  }

  choosePlace() {
    const rows = this.rows.filter((row) => row.place === Number(this.get('image-place').value));
    const kinds = Object.keys(pixelKinds).filter((kind) => rows.some((row) => this.kindsOf(row).includes(kind)));
    const entries = rows.map((row) => [row.id, row.label]);
    fillSelect(this.get('image-kind'), kinds.map((kind) => [kind, pixelKinds[kind].title]), this.get('image-kind').value);
    fillSelect(this.get('image-left'), entries);
    fillSelect(this.get('image-right'), entries, entries[Math.min(1, entries.length - 1)][0]);
    return this.draw();
  }

  // ImageData of an embedded image.
  async pixels(index) {
    if (index === undefined) return null;
    if (!this.decoded.has(index)) {
      const image = new Image();
      image.src = this.report.images[index];
      this.decoded.set(index, image.decode().then(() => {
        const canvas = document.createElement('canvas');
        canvas.width = image.naturalWidth;
        canvas.height = image.naturalHeight;
        const context = canvas.getContext('2d', {willReadFrequently: true});
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, canvas.width, canvas.height);
      }));
    }
    return this.decoded.get(index);
  }

  async shown(row, kind) {
    if (kind !== 'error') return this.pixels(row.images[kind]);
    const [result, reference, domain] =
        await Promise.all(['visibility', 'reference', 'domain'].map((name) => this.pixels(row.images[name])));
    return falseColour(result, reference, domain);
  }

  async draw() {
    const turn = ++this.turn;
    const kind = this.get('image-kind').value;
    const row = (id) => this.report.rows[Number(this.get(id).value)];
    const left = row('image-left'), right = row('image-right');
    const [a, b, reference] = await Promise.all([
      this.kindsOf(left).includes(kind) ? this.shown(left, kind) : null,
      this.kindsOf(right).includes(kind) ? this.shown(right, kind) : null,
      this.pixels(left.images[pixelKinds[kind].reference])]);
    if (turn !== this.turn) return;
    paint(this.get('image-a'), a);
    paint(this.get('image-b'), b);
    paint(this.get('image-reference'), reference);
    this.get('image-caption').textContent = `left: ${left.label} · right: ${right.label}` + (kind === 'error' ?
        ' · blue: too dark, red: too light, white: right, grey: not counted; in steps of 1/255' : '');
    this.get('reference-caption').textContent =
        kind === 'color' ? 'the reference, shaded' : 'the ray-traced reference';
    this.current = {left, right};
    this.place();
    this.fit();
  }

  place() {
    const share = this.get('slider').value;
    this.get('image-b').style.clipPath = `inset(0 0 0 ${share}%)`;
    this.get('slider-line').style.left = `${share}%`;
  }

  fit() {
    const fit = this.get('image-fit').checked;
    this.get('slider-box').classList.toggle('fit', fit);
    this.get('image-reference').classList.toggle('fit', fit);
  }

  // Visibilities of the pixel under the pointer.
  async read(event) {
    const box = this.get('slider-box').getBoundingClientRect();
    const canvas = this.get('image-a');
    const x = Math.floor((event.clientX - box.left) / box.width * canvas.width);
    const y = Math.floor((event.clientY - box.top) / box.height * canvas.height);
    if (!this.current || x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) return;
    const {left, right} = this.current;
    const images = await Promise.all([left.images.visibility, right.images.visibility, left.images.reference].map(
        (index) => this.pixels(index)));
    const value = (image) => image ? (image.data[4 * (y * image.width + x)] / 255).toFixed(3) : '–';
    this.get('pixel').textContent =
        `pixel ${x}, ${y}: visibility left ${value(images[0])}, right ${value(images[1])}, reference ${value(images[2])}`;
  }
}

function paint(canvas, pixels) {
  if (!pixels) {
    canvas.width = canvas.width;  // clears
    return;
  }
  canvas.width = pixels.width;
  canvas.height = pixels.height;
  canvas.getContext('2d').putImageData(pixels, 0, 0);
}

// White where equal, towards red where the result is lighter, towards blue where it is darker. The square root
// makes small errors visible.
function falseColour(result, reference, domain) {
  const image = new ImageData(result.width, result.height);
  for (let i = 0; i < result.data.length; i += 4) {
    const counted = !domain || domain.data[i] > 127;
    const difference = (result.data[i] - reference.data[i]) / 255;
    const rest = 255 * (1 - Math.sqrt(Math.abs(difference)));
    const colour = !counted ? [200, 200, 200] : difference > 0 ? [255, rest, rest] : [rest, rest, 255];
    image.data.set([...colour.map(Math.round), 255], i);
  }
  return image;
}
