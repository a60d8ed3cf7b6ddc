// What a PNG file says of its own size, before a decoder believes it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace gnomon::png {

// What is wrong, empty: nothing. A chunk that is longer than the rest of the file, or more pixels than its
// bytes can hold (deflate makes at most 1032 bytes of one): decoders would take memory for them. Bytes that
// are no PNG claim nothing.
std::string false_claim(std::span<const uint8_t> bytes);

}  // namespace gnomon::png
