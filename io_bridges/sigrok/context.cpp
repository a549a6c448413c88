#include "io_bridges/sigrok/context.hpp"

#include <cstdarg>
#include <cstdio>
#include <utility>

namespace whirl::sigrok {
namespace {

std::mutex mutex;
std::string complaint;

int keep(void* /*data*/, int level, const char* format, va_list args) {
  if (level > SR_LOG_WARN) return 0;
  char text[300];
  std::vsnprintf(text, sizeof text, format, args);
  const std::scoped_lock lock(mutex);
  complaint = text;
  return 0;
}

}  // namespace

Context::Context() {
  sr_log_callback_set(keep, nullptr);
  sr_log_loglevel_set(SR_LOG_WARN);
  if (sr_init(&context_) != SR_OK) context_ = nullptr;
}

Context::~Context() {
  if (context_ != nullptr) sr_exit(context_);
}

std::string Context::last_complaint() {
  const std::scoped_lock lock(mutex);
  return std::exchange(complaint, {});
}

}  // namespace whirl::sigrok
