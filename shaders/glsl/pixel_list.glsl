// Lists of pixels that one dispatch makes and another, indirect one, works off: the work follows the pixels that need it. Uses
// the buffers of passes/pixel_list.h.
const uint LIST_GROUP = 64u;  // invocations in a workgroup of the pass that works the list off, a pixel each

// `width`: of the image.
void list_pixel(ivec2 pixel, int width) {
  uint slot = atomicAdd(arguments[3], 1u);
  if (slot % LIST_GROUP == 0u) atomicMax(arguments[0], slot / LIST_GROUP + 1u);
  listed[slot] = pixel.y * width + pixel.x;
}

// False for invocations beyond the list's end.
bool listed_pixel(uint slot, int width, out ivec2 pixel) {
  bool there = slot < arguments[3];
  uint index = there ? listed[slot] : 0u;
  pixel = ivec2(index % width, index / width);
  return there;
}
