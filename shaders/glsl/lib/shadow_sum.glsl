// The banding test of adaptive light sampling for 32 pixels of a row at a time (Macedo 2018, ch. 6.1.1; Schwaerzler et al.
// 2012). Pure functions on bits: bit i is pixel i of the row.
#ifndef GNOMON_SHADOW_SUM
#define GNOMON_SHADOW_SUM

struct ShadowSum {
  uint ones, twos, fours;  // binary digits of each pixel's sum, 0..4
};

// (6.1): how many of a quad's four samples a pixel is lit from; also the number of silhouettes it lies on.
ShadowSum shadow_sum(uvec4 bits) {
  uint ab = bits.x ^ bits.y, cd = bits.z ^ bits.w, both_ab = bits.x & bits.y, both_cd = bits.z & bits.w;
  return ShadowSum(ab ^ cd, (both_ab ^ both_cd) | (ab & cd), both_ab & both_cd);
}

// Pixels whose sum is at least `least`; none for 5 and more.
uint at_least(ShadowSum sum, int least) {
  uint any = sum.ones | sum.twos | sum.fours;
  return least <= 0 ? 0xFFFFFFFFu
       : least == 1 ? any
       : least == 2 ? sum.twos | sum.fours
       : least == 3 ? (sum.twos & sum.ones) | sum.fours
       : least == 4 ? sum.fours
                    : 0u;
}

uint in_penumbra(ShadowSum sum) { return (sum.ones | sum.twos) & ~sum.fours; }

uint differs(ShadowSum a, ShadowSum b) { return (a.ones ^ b.ones) | (a.twos ^ b.twos) | (a.fours ^ b.fours); }

#endif
