// Proximate sites of each row and colouring (Cao et al. 2010, phases 2 and 3). The nearest site of a row's pixel is that of one of
// the columns that distance_transform_prune kept, in which phase 1 found the nearest: a lower envelope of parabolas, kept as a
// stack of those sites that are nearest somewhere on the row. The stack is in memory where the result of the same row will be,
// which is filled from its end and so never overtakes what is still needed. An invocation has a row, because neighbouring rows
// share the words of bits; rows below the image are swept like others, and not copied.
//
// A row is swept in bands of columns, one dispatch each, and coloured in bands from its end: software devices stop loops after some
// 65000 iterations of an invocation. Only the number of entries goes from one band to the next; the rest follows from the stack.
#include "distance/distance_transform_column.glsl"

layout(local_size_x = 32) in;  // rows of a word
#include "lib/subgroup.glsl"

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

// Where `pops`. What it loads is loaded on all rows: software devices are quicker so than by asking each whether it must.
void pop(bool pops) {
  Entry third = make_entry(site_at(max(count - 3, 0)));
  int start = start_of(third, second);
  if (pops) {
    --count;
    top = second;
    top_start = count >= 2 ? start : 0;
    second = third;
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

// Is there a top that, where it begins to be nearest, is farther than `e`? Then it is so everywhere: e's share of the row lies to
// the right. The same as start_of(top, e) <= top_start, without its division.
bool hides_top(Entry e) { return count > 0 && e.lift - top.lift < 2 * (e.x - top.x) * top_start; }

void add_site(ivec2 site) {
  bool is_site = is_row(site.y);
  Entry e = make_entry(site);
  bool hides = is_site && hides_top(e);
  do {
    pop(hides);
    hides = hides && hides_top(e);
  } while (hides);
  int start = count > 0 ? start_of(top, e) : 0;
  if (is_site && start < row_length) push(e, start);
}

// The site of a column that is nearest on this row.
ivec2 site_in(int x, int word, int layer) {
  return ivec2(x, nearest_in_column(load_column(x, word, layer), word * WORD, y));
}

void find_proximate(int word, int layer) {
  for (int chunk = stripe.begin; chunk < stripe.end; chunk += CHUNK) {
    uint columns = imageLoad(kept, ivec3(chunk / CHUNK, word, layer)).x;
    if (columns == 0u) continue;
    ivec2 site = site_in(chunk + findLSB(columns), word, layer);
    do {
      columns &= columns - 1u;
      ivec2 next = site_in(chunk + max(findLSB(columns), 0), word, layer);  // loaded while this one is added
      add_site(site);
      site = next;
    } while (columns != 0u);
  }
}

// In runs of pixels on which no row's top changes.
void colour() {
  for (int x = stripe.end - 1; x >= stripe.begin;) {
    int last = max(max_of_subgroup(count > 1 ? top_start : 0), stripe.begin);
    do {
      rows[row_begin + x] = top.site;
      --x;
    } while (x >= last);
    pop(count > 1 && top_start > x);
  }
}

// Dealt out, because neighbouring words cost alike, and software devices give each processor a contiguous share of the workgroups.
int word_of_workgroup() {
  int group = int(gl_WorkGroupID.x), even = (int(gl_NumWorkGroups.x) + 1) / 2;
  return stripe.first_word + (group < even ? 2 * group : 2 * (group - even) + 1);
}

void main() {
  int word = word_of_workgroup();
  y = word * WORD + int(gl_LocalInvocationID.x);
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
