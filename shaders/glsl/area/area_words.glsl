// What adaptive sampling keeps of each sample and pixel: is the pixel lit, and does it lie on the sample's silhouette
// (algorithm 6's discontinuity map)? Bits instead of maps: a pixel's words hold 32 samples each, bit i of word w of sample
// 32 w + i; a sample's planes hold 32 pixels of a row a word. Uses the buffers of passes/area/area_refine.cpp.

uint pixel_count() { return uint(frame.viewport.x) * uint(frame.viewport.y); }
uint word_place(uint word, ivec2 pixel) { return word * pixel_count() + uint(pixel.y) * uint(frame.viewport.x) + uint(pixel.x); }

uint words_a_row() { return (uint(frame.viewport.x) + 31u) / 32u; }
uint plane_place(uint sample_slot, uint row, uint word) {
  return (sample_slot * uint(frame.viewport.y) + row) * words_a_row() + word;
}
