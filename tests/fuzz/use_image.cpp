// What is done with images: masks of `edt`, results and references of `compare`.
#include "engine/base/error.h"
#include "engine/image/image.h"
#include "engine/truth/reference.h"
#include "tests/fuzz/target.h"
#include "tools/edt.h"

namespace gnomon::fuzz {
namespace {

// What refuses an image for one purpose must not keep it from the next.
template <class Work>
void unless_refused(Work work) {
  try {
    work();
  } catch (const Error&) {
    return;
  }
}

}  // namespace

void use_mask(const std::filesystem::path& file) {
  const Image image = read_image(file);
  unless_refused([&] { reference_from_image(image, file); });
  for (const char* name : {"Y", "light1", "luminance"})
    unless_refused([&] { scalar_values(image, name, file.string()); });
  edt_mask(image, file.string());
}

}  // namespace gnomon::fuzz
