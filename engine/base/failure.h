// Whatever was thrown, as the project's one kind of error.
#pragma once

#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/error.h"

namespace gnomon {

// The problems of an Error as they are; anything else in plain words: exceptions of the file system with
// their path, of JSON without their numbers, memory that has run out. `input`: what was being worked on, as
// the place where none is known.
std::vector<Problem> problems_of(std::exception_ptr thrown, const std::string& input);

// Calls `work`; what it throws is an Error that names `input`.
template <class Work>
auto naming(const std::string& input, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const Error&) {
    throw;
  } catch (...) {
    throw Error(problems_of(std::current_exception(), input));
  }
}

}  // namespace gnomon
