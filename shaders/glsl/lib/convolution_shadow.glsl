// Convolution shadow maps (Annen, Mertens, Bekaert, Seidel and Kautz 2007): the shadow test as a Fourier series, a sum of
// products of a function of the map's depth z and one of the receiver's depth d. Pure functions.
#ifndef GNOMON_CONVOLUTION_SHADOW
#define GNOMON_CONVOLUTION_SHADOW

const float CSM_PI = 3.14159265;

// Frequency of the k-th term, k = 0 the first: c_k = pi (2k + 1), a square wave of period 2 in z - d (eq. 5).
float csm_frequency(int k) { return CSM_PI * float(2 * k + 1); }

// What the map stores of term k: cos(c_k z), sin(c_k z). Successive terms are a rotation by 2 pi z apart.
vec2 csm_first(float z) { return vec2(cos(CSM_PI * z), sin(CSM_PI * z)); }
vec2 csm_rotation(float z) { return vec2(cos(2.0 * CSM_PI * z), sin(2.0 * CSM_PI * z)); }
vec2 csm_next(vec2 term, vec2 rotation) {
  return vec2(term.x * rotation.x - term.y * rotation.y, term.x * rotation.y + term.y * rotation.x);
}

// Term k of (6), for the filtered basis `b` and that of the receiver's depth d:
// 2 / c_k (cos(c_k d) [sin(c_k z)] - sin(c_k d) [cos(c_k z)]). `ringing` attenuates high frequencies by
// e^(-ringing (k/M)^2), M terms in all (section 4.3).
float csm_term(vec2 b, vec2 receiver, int k, int terms, float ringing) {
  float part = float(k) / float(terms);
  return 2.0 / csm_frequency(k) * exp(-ringing * part * part) * (receiver.x * b.y - receiver.y * b.x);
}

// The series is 1/2 where receiver and map meet, which on a lit surface they do: doubled and cut off at 1, a surface lights
// itself and a fraction p of occluders in the kernel leaves 1 - p (section 4.3, scaling).
float csm_visibility(float sum_of_terms) { return clamp(2.0 * (0.5 + sum_of_terms), 0.0, 1.0); }

#endif
