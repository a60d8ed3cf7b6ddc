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

// Functions of a list: `add` puts a pixel of an image of this width into it; `get` is false for invocations beyond the list's end.
#define PIXEL_LIST(add, get, pixels, words)                                     \
  void add(ivec2 pixel, int width) {                                            \
    uint slot = atomicAdd(words[3], 1u);                                        \
    if (slot % LIST_GROUP == 0u) {                                              \
      atomicMax(words[0], list_groups(slot).x);                                 \
      if (list_groups(slot).y > 1u) atomicMax(words[1], list_groups(slot).y);   \
    }                                                                           \
    pixels[slot] = pixel.y * width + pixel.x;                                   \
  }                                                                             \
  bool get(uint slot, int width, out ivec2 pixel) {                             \
    bool there = slot < words[3];                                               \
    uint index = there ? pixels[slot] : 0u;                                     \
    pixel = ivec2(index % width, index / width);                                \
    return there;                                                               \
  }

PIXEL_LIST(list_pixel, listed_pixel, listed, arguments)
