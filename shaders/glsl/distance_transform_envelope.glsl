// Proximate sites of each row and colouring (Cao et al. 2010, phases 2 and 3). The nearest site of a row's pixel is that of one of
// the columns that distance_transform_prune kept, in which phase 1 found the nearest: a lower envelope of parabolas, kept as a
// stack of those sites that are nearest somewhere on the row. The stack is in memory where the result of the same row will be,
// which is filled from its end and so never overtakes what is still needed. An invocation has a row, because neighbouring rows
// share the words of bits.
//
// A row is swept in bands of columns, one dispatch each, and coloured in bands from its end: software devices stop loops after some
// 65000 turns of an invocation. Only the number of entries goes from one band to the next; the rest follows from the stack.
#extension GL_KHR_shader_subgroup_vote : require
#include "lib/distance_transform.glsl"

layout(local_size_x = 32) in;  // rows of a word

#define BAND_WHOLE 0  // the only one: sweep and colour at once
#define BAND_SWEEP 1
#define BAND_COLOUR 2

// A site that is nearest somewhere on this row.
struct Entry {
  uint site;
  int x, lift;  // see last_not_above()
};

layout(push_constant) uniform Stripe { ivec2 size; int layer, first_word, begin, end; } stripe;  // of the image; columns of the band

int y, row_length, row_begin;
Entry top, second;  // of the stack; what is below is in memory
int top_start;      // first pixel of the row whose nearest site is the top
int count;

Entry make_entry(ivec2 site) {
  Entry e;
  e.site = pack_site(site);
  e.x = site.x;
  e.lift = square(site.x) + square(site.y - y);
  return e;
}

ivec2 site_at(int entry) {
  ivec2 site;
  unpack_site(rows[row_begin + entry], site);
  return site;
}

int start_of(Entry below, Entry above) {
  return 1 + last_not_above(below.x, below.lift, above.x, above.lift, row_length);
}

void push(Entry e, int start) {
  rows[row_begin + count] = e.site;
  second = top;
  top = e;
  top_start = start;
  ++count;
}

void pop() {
  --count;
  top = second;
  top_start = 0;
  if (count >= 2) {
    second = make_entry(site_at(count - 2));
    top_start = start_of(second, top);
  }
}

void resume(int entries) {
  count = entries;
  top = make_entry(ivec2(0));
  top.site = NO_SITE;
  top_start = 0;
  second = top;
  if (count >= 1) top = make_entry(site_at(count - 1));
  if (count >= 2) {
    second = make_entry(site_at(count - 2));
    top_start = start_of(second, top);
  }
}

void find_proximate(int word, int layer) {
  for (int chunk = stripe.begin; chunk < stripe.end; chunk += CHUNK) {
    uint columns = imageLoad(kept, ivec3(chunk / CHUNK, word, layer)).x;
    while (columns != 0u) {
      Entry e;
      int start;
      bool pops, pops_anywhere;
      do {
        int x = chunk + findLSB(columns);
        columns &= columns - 1u;
        int row = nearest_in_column(imageLoad(words, ivec3(x, word, layer)).xy, word * WORD, y);
        e = make_entry(ivec2(x, row));
        start = count > 0 ? start_of(top, e) : 0;
        bool is_site = is_row(row);
        pops = is_site && count > 0 && start <= top_start;
        if (is_site && !pops && start < row_length) push(e, start);
        pops_anywhere = subgroupAny(pops);
      } while (!pops_anywhere && columns != 0u);
      bool popped = pops;
      while (pops) {
        pop();
        start = count > 0 ? start_of(top, e) : 0;
        pops = count > 0 && start <= top_start;
      }
      if (popped && start < row_length) push(e, start);
    }
  }
}

void colour() {
  for (int x = stripe.end - 1; x >= stripe.begin;) {
    bool ends;
    do {
      rows[row_begin + x] = top.site;
      ends = x == top_start && count > 1;
      --x;
    } while (!subgroupAny(ends) && x >= stripe.begin);
    if (ends) pop();
  }
}

void main() {
  int word = stripe.first_word + int(gl_WorkGroupID.x);
  y = word * WORD + int(gl_LocalInvocationID.x);
  if (y >= stripe.size.y) return;
  row_length = stripe.size.x;
  row_begin = (y - stripe.first_word * WORD) * stripe.size.x;
#if BAND == BAND_WHOLE
  resume(0);
  find_proximate(word, stripe.layer);
  colour();
#else
  int row = y - stripe.first_word * WORD;
#if BAND == BAND_SWEEP
  resume(stripe.begin == 0 ? 0 : int(counts[row]));
  find_proximate(word, stripe.layer);
#else
  resume(int(counts[row]));
  colour();
#endif
  counts[row] = uint(count);
#endif
}
