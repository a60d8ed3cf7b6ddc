// Data URIs and relative references, and the bytes behind them.
#include "engine/scene/gltf_uri.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>

#include "engine/base/error.h"

namespace gnomon {
namespace {

bool is_data(const std::string& uri) { return uri.rfind("data:", 0) == 0; }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

// A scheme has at least two letters here, so that a drive's letter is none.
bool has_scheme(const std::string& uri) {
  const size_t colon = uri.find(':');
  return colon != std::string::npos && colon > 1 &&
         std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.';
         });
}

int base64_digit(char c) {
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const size_t place = digits.find(c);
  return place == std::string_view::npos ? -1 : static_cast<int>(place);
}

// RFC 4648, section 4.
Bytes base64_decoded(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  static const auto table = [] {
    std::vector<int> values(256);
    for (int i = 0; i < 256; ++i) values[static_cast<size_t>(i)] = base64_digit(static_cast<char>(i));
    return values;
  }();
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int digit = table[static_cast<unsigned char>(c)];
    if (digit < 0) fail("the data URI is not base64");
    bits = bits << 6 | static_cast<uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> count & 0xFF));
  }
  return bytes;
}

Bytes data_bytes(const std::string& uri) {
  const size_t comma = uri.find(',');
  if (comma == std::string::npos) fail("the data URI has no comma");
  constexpr std::string_view base64 = ";base64";
  const std::string_view kind = std::string_view(uri).substr(0, comma);
  if (kind.size() >= base64.size() && kind.substr(kind.size() - base64.size()) == base64)
    return base64_decoded(std::string_view(uri).substr(comma + 1));
  const std::string text = percent_decoded(uri.substr(comma + 1));
  return {text.begin(), text.end()};
}

std::filesystem::path path_of(const std::filesystem::path& folder, const std::string& uri) {
  return folder / percent_decoded(uri);
}

}  // namespace

std::string shown_uri(const std::string& uri) {
  constexpr size_t longest = 40;
  return is_data(uri) && uri.size() > longest ? uri.substr(0, longest) + "..." : uri;
}

std::string percent_decoded(const std::string& text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = high >= 0 ? hex_digit(text[i + 2]) : -1;
    if (text[i] != '%' || low < 0) {
      result += text[i];
      continue;
    }
    result += static_cast<char>(high << 4 | low);
    i += 2;
  }
  return result;
}

Bytes read_uri(const std::filesystem::path& folder, const std::string& uri, uint64_t most) {
  if (is_data(uri)) {
    Bytes bytes = data_bytes(uri);
    if (bytes.size() > most) bytes.resize(most);
    return bytes;
  }
  if (has_scheme(uri))
    fail("the URI is neither a data URI nor a relative reference", {}, {}, "save the file beside the scene");
  const std::filesystem::path path = path_of(folder, uri);
  if (uri.empty() || path.native().find('\0') != std::string::npos) fail("the URI names no file");
  return read_bytes(path, most);
}

bool is_outside(const std::filesystem::path& folder, const std::string& uri) {
  if (is_data(uri) || has_scheme(uri)) return false;
  std::error_code ignored;
  const std::filesystem::path home =
      std::filesystem::weakly_canonical(folder.empty() ? std::filesystem::path(".") : folder, ignored);
  const std::filesystem::path target = std::filesystem::weakly_canonical(path_of(home, uri), ignored);
  const std::filesystem::path way = target.lexically_relative(home);
  // An absolute path says more than the scene's place, even where it leads there.
  return way.empty() || *way.begin() == ".." || std::filesystem::path(percent_decoded(uri)).is_absolute();
}

Bytes read_bytes(const std::filesystem::path& path, uint64_t most) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail("no such file");
  if (!std::filesystem::is_regular_file(path, error)) fail("not a file");
  const uint64_t size = std::filesystem::file_size(path, error);
  if (error) fail("cannot be read: " + error.message());
  if (std::min(size, most) > kMaxFileSize) fail("larger than 2 GiB", {}, {}, "split the scene");
  Bytes bytes(std::min(size, most));
  std::ifstream in(path, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())) &&
      !bytes.empty())
    fail("cannot be read");
  return bytes;
}

}  // namespace gnomon
