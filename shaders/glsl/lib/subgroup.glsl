// Over the invocations of a subgroup, all of which must take part, of a workgroup that has only x. With shuffles, which
// software devices turn into an instruction each, while they walk all invocations for a vote.
#ifndef GNOMON_SUBGROUP
#define GNOMON_SUBGROUP

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

const uint SUBGROUP_INVOCATIONS = min(uint(SUBGROUP_SIZE), gl_WorkGroupSize.x);
const int SUBGROUP_HALVINGS = SUBGROUP_INVOCATIONS > 64u ? 7 : SUBGROUP_INVOCATIONS > 32u ? 6 : SUBGROUP_INVOCATIONS > 16u ? 5 :
                              SUBGROUP_INVOCATIONS > 8u ? 4 : SUBGROUP_INVOCATIONS > 4u ? 3 : 2;

// Counted in steps of one, so that compilers unroll it.
int max_of_subgroup(int v) {
  for (int i = 0; i < SUBGROUP_HALVINGS; ++i) v = max(v, subgroupShuffleXor(v, 1u << i));
  return v;
}
bool any_of_subgroup(bool v) { return max_of_subgroup(int(v)) != 0; }

#endif
