#include "passes/pixel_list.h"

namespace gnomon {

void clear_list(Context& c, const std::string& arguments) {
  constexpr uint64_t kWord = 4;  // bytes
  c.fill(arguments, 0, 0, kWord);
  c.fill(arguments, 1, kWord, 2 * kWord);
  c.fill(arguments, 0, 3 * kWord, kWord);
}

}  // namespace gnomon
