// Separable filters with a width of its own for each pixel: every pixel reads its window itself, however wide it is. Whoever
// includes it defines before that
//   float filtered(Strip strip, int place, Receiving centre, float half_width)   of a pixel that receives
// and after screen/strip_filter_line.glsl.
void filter_cell(Strip strip, int cell) {
  int first = strip.reach + 1 + cell * CELL;
  for (int place = first; place < first + CELL; ++place) {
    ivec2 pixel = pixel_of(strip, place);
    Receiving here = surface_at(strip, place, true);
    float v = source_at(pixel, strip.layer);
    float reach = here.receives ? half_width(clamp(pixel, ivec2(0), image_size() - 1), strip.layer, here.depth) : 0.0;
    if (reach > 0.0) v = filtered(strip, place, here, reach);
    store(pixel, strip.layer, v);
  }
}

void main() {
  Strip strip = strip_of_workgroup();
  for (int cell = part(); cell < STRIP; cell += PARTS)
    if (is_needed(strip, cell)) filter_cell(strip, cell);
}
