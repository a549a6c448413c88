// libsigrok's context, and the last thing that it complained of.
#pragma once
#include <libsigrok/libsigrok.h>

#include <memory>
#include <mutex>
#include <string>

namespace whirl::sigrok {

class Context {
 public:
  Context();
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  sr_context* get() const { return context_; }
  // Since the last call.
  static std::string last_complaint();

 private:
  sr_context* context_ = nullptr;
};

struct SessionCloser {
  void operator()(sr_session* session) const { sr_session_destroy(session); }
};
using Session = std::unique_ptr<sr_session, SessionCloser>;

}  // namespace whirl::sigrok
