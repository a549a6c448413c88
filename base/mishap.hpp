// What was thrown, as an Error: for the one catch at the top of a process, a plan or a report.
#pragma once
#include <exception>
#include <filesystem>
#include <ios>
#include <new>
#include <system_error>

#include "base/result.hpp"

namespace whirl {

// Pre: within a catch block.
inline Error error_of_current_exception() {
  try {
    throw;
  } catch (const base::CheckFailed& e) {
    return {ErrorKind::internal, "", e.what(), "this is a bug in whirl"};
  } catch (const std::bad_alloc&) {
    return {ErrorKind::host, "", "out of memory", ""};
  } catch (const std::filesystem::filesystem_error& e) {
    return {ErrorKind::host, e.path1().string(), e.code().message(), ""};
  } catch (const std::system_error& e) {  // of a stream that cannot be read, too
    return {ErrorKind::host, "", e.what(), ""};
  } catch (const std::exception& e) {
    return {ErrorKind::internal, "", std::string("unexpected: ") + e.what(),
            "this is a bug in whirl"};
  }
}

}  // namespace whirl
