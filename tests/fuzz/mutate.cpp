// Mutates JSON as a tree, lines of it one by one, and the two chunks of a GLB with their lengths put right.
#include "tests/fuzz/mutate.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <vector>

namespace gnomon::fuzz {
namespace {

using nlohmann::json;

class Mutation {
 public:
  Mutation(unsigned seed, MutateBytes formless) : random_(seed), formless_(formless) {}

  size_t below(size_t count) { return random_() % std::max<size_t>(count, 1); }
  bool once_in(size_t count) { return below(count) == 0; }
  std::string bytes(const std::string& text, size_t most) { return formless_(text, most); }

  void tree(json& document) {
    for (size_t left = 1 + below(3); left > 0; --left) change(document);
  }

 private:
  static void collect(json& node, std::vector<json*>& all) {
    all.push_back(&node);
    for (json& child : node)
      if (node.is_structured()) collect(child, all);
  }

  json scalar() {
    static const std::vector<json> interesting = {nullptr,
                                                  true,
                                                  false,
                                                  0,
                                                  1,
                                                  2,
                                                  -1,
                                                  3,
                                                  255,
                                                  256,
                                                  65535,
                                                  65536,
                                                  2147483647,
                                                  -2147483648ll,
                                                  4294967295ll,
                                                  4294967296ll,
                                                  INT64_MAX,
                                                  INT64_MIN,
                                                  UINT64_MAX,
                                                  0.5,
                                                  -0.0,
                                                  1e-320,
                                                  1e-30,
                                                  1e19,
                                                  1e38,
                                                  1e39,
                                                  1.7976931348623157e308,
                                                  "",
                                                  "a",
                                                  "..",
                                                  "/",
                                                  "$",
                                                  "\x1b[2J\n",
                                                  json::array(),
                                                  json::object()};
    return interesting[below(interesting.size())];
  }

  json arithmetic(const json& number) {
    if (number.is_number_float()) {
      const double v = number.get<double>();
      const double values[] = {-v, v * 2, v / 2, v + 1, v * 1e6, v * 1e-6};
      return values[below(std::size(values))];
    }
    const auto v = number.get<uint64_t>();
    const uint64_t values[] = {v + 1, v - 1, v * 2, v / 2, ~v + 1, v * 1000};
    const uint64_t chosen = values[below(std::size(values))];
    return chosen > UINT64_MAX / 2 ? json(static_cast<int64_t>(chosen)) : json(chosen);
  }

  void change_members(json& object, const json& other) {
    if (!object.empty() && once_in(2)) {
      auto member = object.begin();
      std::advance(member, below(object.size()));
      object.erase(member);
    } else if (other.is_object() && !other.empty()) {
      auto member = other.begin();
      std::advance(member, below(other.size()));
      object[member.key()] = json(member.value());
    }
  }

  void change_elements(json& array, const json& other) {
    constexpr size_t many = 40;
    const size_t at = below(array.size());
    switch (below(4)) {
      case 0:
        if (!array.empty()) array.erase(array.begin() + std::ptrdiff_t(at));
        break;
      case 1:
        array.push_back(array.empty() ? other : json(array[at]));
        break;
      case 2:
        array.insert(array.begin() + std::ptrdiff_t(at), other);
        break;
      default:
        if (!array.empty()) array.insert(array.end(), below(many), json(array[at]));
    }
  }

  void change(json& document) {
    std::vector<json*> all;
    collect(document, all);
    json& node = *all[below(all.size())];
    const json other = *all[below(all.size())];
    constexpr size_t most_text = 64;
    if (once_in(5)) {
      node = scalar();
    } else if (once_in(6)) {
      node = other;
    } else if (node.is_object()) {
      change_members(node, other);
    } else if (node.is_array()) {
      change_elements(node, other);
    } else if (node.is_number()) {
      node = arithmetic(node);
    } else if (node.is_string()) {
      node = once_in(2) && other.is_string() ? other : json(bytes(node.get<std::string>(), most_text));
    } else {
      node = scalar();
    }
  }

  std::mt19937 random_;
  MutateBytes formless_;
};

std::string dumped(const json& document) {
  return document.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string mutated_json(Mutation& mutation, const std::string& text, size_t most) {
  constexpr size_t formless = 6;  // once in so many
  json document =
      mutation.once_in(formless) ? json(json::value_t::discarded) : json::parse(text, nullptr, false, true);
  if (document.is_discarded()) return mutation.bytes(text, most);
  mutation.tree(document);
  return dumped(document);
}

std::string mutated_lines(Mutation& mutation, const std::string& text, size_t most) {
  std::vector<size_t> starts = {0};
  for (size_t i = 0; i + 1 < text.size(); ++i)
    if (text[i] == '\n') starts.push_back(i + 1);
  const size_t start = starts[mutation.below(starts.size())];
  const size_t end = std::min(text.find('\n', start), text.size());
  const std::string line = text.substr(start, end - start);
  if (mutation.once_in(8)) return text + line + "\n";
  const std::string before = text.substr(0, start), after = text.substr(end);
  const size_t room = most > before.size() + after.size() ? most - before.size() - after.size() : 0;
  return before + mutated_json(mutation, line, room) + after;
}

uint32_t word(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
std::string as_word(size_t value) {
  const auto narrow = static_cast<uint32_t>(value);
  return {reinterpret_cast<const char*>(&narrow), sizeof narrow};
}

struct Glb {
  json document;
  std::string binary;

  static std::optional<Glb> parse(const std::string& bytes) {
    constexpr size_t header = 20, chunk = 8;
    if (bytes.size() < header || bytes.compare(0, 4, "glTF") != 0) return std::nullopt;
    const size_t end = header + size_t{word(bytes, 12)};
    if (end > bytes.size()) return std::nullopt;
    Glb glb{json::parse(bytes.substr(header, end - header), nullptr, false), {}};
    if (glb.document.is_discarded()) return std::nullopt;
    if (end + chunk <= bytes.size()) glb.binary = bytes.substr(end + chunk, word(bytes, end));
    return glb;
  }

  std::string bytes() const {
    std::string text = dumped(document), data = binary;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    data.resize((data.size() + 3) / 4 * 4, '\0');
    return "glTF" + as_word(2) + as_word(28 + text.size() + data.size()) + as_word(text.size()) + "JSON" +
           text + as_word(data.size()) + std::string("BIN\0", 4) + data;
  }
};

std::string mutated_gltf(Mutation& mutation, const std::string& bytes, size_t most) {
  std::optional<Glb> glb = Glb::parse(bytes);
  if (!glb) return mutated_json(mutation, bytes, most);
  if (mutation.once_in(12)) return mutation.bytes(bytes, most);
  if (mutation.once_in(3) && !glb->binary.empty()) {
    glb->binary = mutation.bytes(glb->binary, std::min(most, glb->binary.size() + 64));
    json& document = glb->document;
    const bool there = document.is_object() && document.contains("buffers") &&
                       document["buffers"].is_array() && !document["buffers"].empty() &&
                       document["buffers"][0].is_object();
    if (there && !mutation.once_in(4)) document["buffers"][0]["byteLength"] = glb->binary.size();
  } else {
    mutation.tree(glb->document);
  }
  return glb->bytes();
}

}  // namespace

std::string mutated(Kind kind, const std::string& bytes, size_t most, unsigned seed, MutateBytes formless) {
  Mutation mutation(seed, formless);
  switch (kind) {
    case Kind::json:
      return mutated_json(mutation, bytes, most);
    case Kind::json_lines:
      return mutated_lines(mutation, bytes, most);
    case Kind::gltf:
      return mutated_gltf(mutation, bytes, most);
    case Kind::bytes:
      break;
  }
  return formless(bytes, most);
}

}  // namespace gnomon::fuzz
