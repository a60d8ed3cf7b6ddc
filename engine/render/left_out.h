// What a frame does without.
#pragma once

#include <string>

namespace gnomon {

struct LeftOutPass {
  std::string pass;
  std::string part;  // of a pass that runs; empty: all of it
  std::string reason;
};

}  // namespace gnomon
