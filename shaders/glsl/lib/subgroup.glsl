// Over the invocations of a subgroup, all of which must take part, of a workgroup that has only x. With shuffles, which software
// devices turn into an instruction each, while they walk all invocations for a vote.
#ifndef GNOMON_SUBGROUP
#define GNOMON_SUBGROUP

#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require

const uint SUBGROUP_INVOCATIONS = min(uint(SUBGROUP_SIZE), gl_WorkGroupSize.x);

int max_of_subgroup(int v) {
  for (uint apart = 1u; apart < SUBGROUP_INVOCATIONS; apart *= 2u) v = max(v, subgroupShuffleXor(v, apart));
  return v;
}
bool any_of_subgroup(bool v) { return max_of_subgroup(int(v)) != 0; }

#endif
