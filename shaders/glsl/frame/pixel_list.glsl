// Lists of pixels that one dispatch makes and another, indirect one, works off: the work follows the pixels that need it. Uses
// the buffers of passes/frame/pixel_list.h.
const uint LIST_GROUP = 64u;  // invocations in a workgroup of the pass that works the list off, a pixel each
const uint LIST_ROW = 32768u;  // workgroups in a row of the dispatch, which every device allows

// Workgroups (x, y) for a list of which `slot` is the last one.
uvec2 list_groups(uint slot) {
  uint group = slot / LIST_GROUP;
  return uvec2(min(group + 1u, LIST_ROW), group / LIST_ROW + 1u);
}

// This invocation's place in the list.
uint list_slot() {
  return (gl_WorkGroupID.y * LIST_ROW + gl_WorkGroupID.x) * LIST_GROUP + gl_LocalInvocationID.x;
}

// `width`: of the image.
void list_pixel(ivec2 pixel, int width) {
  uint slot = atomicAdd(arguments[3], 1u);
  if (slot % LIST_GROUP == 0u) {
    atomicMax(arguments[0], list_groups(slot).x);
    if (list_groups(slot).y > 1u) atomicMax(arguments[1], list_groups(slot).y);
  }
  listed[slot] = pixel.y * width + pixel.x;
}

// False for invocations beyond the list's end.
bool listed_pixel(uint slot, int width, out ivec2 pixel) {
  bool there = slot < arguments[3];
  uint index = there ? listed[slot] : 0u;
  pixel = ivec2(index % width, index / width);
  return there;
}
