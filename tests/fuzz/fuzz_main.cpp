// A program of libFuzzer for the target GNOMON_FUZZ_TARGET. With --seeds FOLDER it writes the seeds and ends.
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "tests/fuzz/mutate.h"
#include "tests/fuzz/target.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace gnomon::fuzz {
namespace {

const Target& here() {
  static const Target& one = target(GNOMON_FUZZ_TARGET);
  return one;
}

void write_seeds(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& [name, bytes] : seeds(here()))
    std::ofstream(folder / name, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

std::string mutated_bytes(std::string bytes, size_t most) {
  const size_t size = bytes.size();
  bytes.resize(std::max(most, size));
  bytes.resize(LLVMFuzzerMutate(reinterpret_cast<uint8_t*>(bytes.data()), size, bytes.size()));
  return bytes;
}

}  // namespace
}  // namespace gnomon::fuzz

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  if (*count != 3 || std::strcmp((*words)[1], "--seeds") != 0) return 0;
  gnomon::fuzz::write_seeds((*words)[2]);
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  gnomon::fuzz::try_input(gnomon::fuzz::here(), {reinterpret_cast<const char*>(data), size});
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::string after =
      gnomon::fuzz::mutated(gnomon::fuzz::here().kind, bytes, max_size, seed, gnomon::fuzz::mutated_bytes);
  if (after.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, after.data(), after.size());
  return after.size();
}
