// Traits that the compiler itself asks for: what stands in for a technique where it throws no shadow.
#pragma once

namespace gnomon {

// Of an image output: true where it is what every technique's visibility is when no light throws a shadow
// that the camera sees. It need not be there when nobody reads it, even when everything else is kept.
inline constexpr const char* kShadowFree = "shadow_free";
// Of any output: the type of a pass that makes a shadow-free output of what this pass gives out, connected by
// names as "from" does.
inline constexpr const char* kShadowFreePass = "shadow_free_pass";

}  // namespace gnomon
