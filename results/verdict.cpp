#include "results/verdict.hpp"

#include <algorithm>
#include <array>

#include "base/result.hpp"

namespace whirl::results {

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass:
      return "pass";
    case Verdict::fail:
      return "fail";
    case Verdict::inconclusive:
      return "inconclusive";
    case Verdict::error:
      return "error";
    case Verdict::none:
      return "none";
  }
  return "?";
}

const char* name(Blame blame) {
  switch (blame) {
    case Blame::firmware:
      return "firmware";
    case Blame::user:
      return "user";
    case Blame::host:
      return "host";
    case Blame::not_shown:
      return "not shown";
    case Blame::harness:
      return "harness";
  }
  return "?";
}

Blame blame_of(const Error& error) {
  switch (error.kind) {
    case ErrorKind::bad_input:
      return Blame::user;
    case ErrorKind::host:
      return Blame::host;
    case ErrorKind::internal:
      return Blame::harness;
  }
  return Blame::harness;
}

Reason reason_of(const Error& error, const std::string& before) {
  return {blame_of(error), before + error.message()};
}

Verdict verdict_of(Blame blame) {
  switch (blame) {
    case Blame::firmware:
      return Verdict::fail;
    case Blame::user:
    case Blame::harness:
      return Verdict::error;
    case Blame::host:
    case Blame::not_shown:
      return Verdict::inconclusive;
  }
  return Verdict::error;
}

int exit_code_of(Blame blame) {
  switch (blame) {
    case Blame::firmware:
      return 1;
    case Blame::user:
      return 2;
    case Blame::host:
    case Blame::not_shown:
      return 3;
    case Blame::harness:
      return 4;
  }
  return 4;
}

const Reason* deciding(const std::vector<Reason>& reasons) {
  enum class Weight { not_shown, cause, firmware };
  const auto weight = [](const Reason& r) {
    if (r.blame == Blame::firmware) return Weight::firmware;
    return r.blame == Blame::not_shown ? Weight::not_shown : Weight::cause;
  };
  const auto first =
      std::max_element(reasons.begin(), reasons.end(),
                       [&](const Reason& a, const Reason& b) { return weight(a) < weight(b); });
  return first == reasons.end() ? nullptr : &*first;
}

int worse_exit_code(int a, int b) {
  // By code: pass, failed, bad input, inconclusive, internal.
  constexpr std::array kRank{0, 2, 3, 1, 4};
  const auto known = [](int code) { return code >= 0 && code <= 4 ? code : 4; };
  a = known(a);
  b = known(b);
  return kRank[static_cast<std::size_t>(a)] >= kRank[static_cast<std::size_t>(b)] ? a : b;
}

}  // namespace whirl::results
