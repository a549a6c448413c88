// Several targets as one: the boards of a plan, and the UARTs that join them.
//
//   Board    a message says by its header which one it is for, or from; each target sees its own as if it
//            were alone (board 0)
//   Wires    what one board has sent on a UART by the end of a step goes into the other's at the start of the
//            next one: the grain of the exchange, 1 ms. Both boards need a `serial` device on that UART
//   Order    board by board, as they are listed; so what came is the same whoever was faster
//   Ends     with the first target that ends or errs, by its name; all of them arrive first
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "harness/target/target.hpp"

namespace whirl {

struct UartWire {
  struct End {
    std::size_t node = 0;
    std::uint16_t uart = 1;  // USART1: 1
  };
  End a, b;
};

class NodeSet final : public Target {
 public:
  struct Entry {
    std::string name;
    std::unique_ptr<Target> target;
  };
  // Pre: one target at least, 256 at most; wires name nodes that there are.
  NodeSet(std::vector<Entry> nodes, std::vector<UartWire> wires);

  Result<Done> start() override;
  void run(std::int64_t until_ns, const io::Batch& sensed) override;
  Result<TargetState> arrive(io::Batch& happened) override;
  void stop(io::Batch& happened) override;
  std::vector<std::pair<std::string, std::string>> versions() const override;
  Offers offers() const override;  // what all of them can

 private:
  void carry(std::size_t from, const io::Batch& happened);

  std::vector<Entry> nodes_;
  std::vector<UartWire> wires_;
  std::vector<io::Batch> inbox_;  // of each node: what its wires bring with the next step
  std::int64_t now_ns_ = 0, until_ns_ = 0;
};

}  // namespace whirl
