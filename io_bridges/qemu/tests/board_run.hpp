// Runs a test image in QEMU for some virtual milliseconds and keeps what it said.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "harness/target/virtual_board.hpp"

namespace whirl::board_test {

std::string image(const std::string& name);  // its path

struct BoardSetup {
  std::string image;
  std::vector<std::string> watch;
  int gdb_port = 0;
  int silence_s = 30;
  std::string mcu = "bench_m4";
  std::string more = {};  // of the description: R"("start":134234112)"
};
VirtualBoardOptions options_for(const BoardSetup& setup);

struct Message {
  io::Header head;
  std::vector<std::uint8_t> payload;
  template <typename T>
  T as() const {
    T value{};
    std::memcpy(&value, payload.data(), std::min(payload.size(), sizeof value));
    return value;
  }
};

struct BoardRun {
  Error error;  // empty `what`: none
  TargetState state = TargetState::running;
  std::vector<Message> messages;
  std::string digest;

  void keep(const io::Batch& batch);
  std::vector<const Message*> of(io::Kind kind) const;
  // What the image said: values written to the bench part's SAY register.
  std::vector<std::uint32_t> said() const;
  std::vector<std::uint32_t> numbers() const;  // the numbers that came from a terminal, a line each
  bool found(const std::string& words) const;  // in some finding
  std::string text_of(const Message& message, std::size_t head = 0) const;
};

// Three threads that compute, for as long as it lives.
class BusyHost {
 public:
  BusyHost();
  ~BusyHost();
  BusyHost(const BusyHost&) = delete;
  BusyHost& operator=(const BusyHost&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

BoardRun run_for(const BoardSetup& setup, int milliseconds);

}  // namespace whirl::board_test
