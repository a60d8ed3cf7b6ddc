// Exceptions of libraries in plain words.
#include "engine/base/failure.h"

#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

namespace gnomon {
namespace {

// "[json.exception.type_error.302] type must be number" -> "type must be number".
std::string without_number(const std::string& message) {
  const size_t end = message.starts_with('[') ? message.find("] ") : std::string::npos;
  return end == std::string::npos ? message : message.substr(end + 2);
}

Problem of_file_system(const std::filesystem::filesystem_error& error, const std::string& input) {
  const std::string path = error.path1().string();
  return {error.code().message(), path.empty() ? input : path, {}, {}};
}

}  // namespace

std::vector<Problem> problems_of(std::exception_ptr thrown, const std::string& input) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const Error& error) {
    return error.problems();
  } catch (const std::filesystem::filesystem_error& error) {
    return {of_file_system(error, input)};
  } catch (const std::system_error& error) {
    return {{error.code().message(), input, {}, {}}};
  } catch (const nlohmann::json::exception& error) {
    return {{"a value is not of the kind that is expected: " + without_number(error.what()), input, {}, {}}};
  } catch (const std::bad_alloc&) {
    return {{"out of memory", input, {}, "a smaller --size or shadow map needs less"}};
  } catch (const std::length_error&) {
    return {{"asks for more than memory can hold", input, {}, {}}};
  } catch (const std::exception& error) {
    return {{error.what(), input, {}, {}}};
  } catch (...) {
    return {{"failed for a reason that is not known", input, {}, {}}};
  }
}

}  // namespace gnomon
