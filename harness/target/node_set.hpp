// Several targets as one: the boards of a plan, and the UARTs that join them.
//
//   Board    a message says by its header which one it is for, or from; each target sees its own as if it
//            were alone (board 0)
//   Wires    what one board has sent on a UART by the end of a step goes into the other's at the start of the
//            next one: the grain of the exchange, 1 ms. Both boards need a `serial` device on that UART
//            A BoardWire is exact in virtual time (io_bridges/link/wire.hpp); its two boards wait for each other
//   Order    board by board, as they are listed; so what came is the same whoever was faster
//   Ends     with the first target that ends or errs, by its name; all of them arrive first. One that dies or hangs
//            while others wait for it over a wire is named, and the wires are closed: so all of them end
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/target/target.hpp"
#include "io_bridges/link/wire.hpp"

namespace whirl {

struct UartWire {
  struct End {
    std::size_t node = 0;
    std::uint16_t uart = 1;  // USART1: 1
  };
  End a, b;
};

struct BoardWireLink {
  std::size_t leader = 0, follower = 0;  // nodes
  io::BoardWire wire;
};

class NodeSet final : public Target {
 public:
  struct Entry {
    std::string name;
    std::unique_ptr<Target> target;
  };
  // Pre: one target at least, 256 at most; wires name nodes that there are.
  NodeSet(std::vector<Entry> nodes, std::vector<UartWire> wires,
          std::vector<BoardWireLink> board_wires = {});

  Result<Done> start() override;
  void run(std::int64_t until_ns, const io::Batch& sensed) override;
  Result<TargetState> arrive(io::Batch& happened) override;
  void stop(io::Batch& happened) override;
  std::vector<std::pair<std::string, std::string>> versions() const override;
  Offers offers() const override;  // what all of them can

 private:
  void carry(std::size_t from, const io::Batch& happened);
  std::optional<Error> look_after(bool silent);
  Error blame(std::size_t node, Error error);
  bool waits_for_another(std::size_t node) const;
  void close_wires();

  std::vector<Entry> nodes_;
  std::vector<UartWire> wires_;
  std::vector<BoardWireLink> board_wires_;
  std::vector<bool> arrived_;     // in this step
  std::optional<Error> blamed_;   // whoever was waited for when it was found
  std::vector<io::Batch> inbox_;  // of each node: what its wires bring with the next step
  std::int64_t now_ns_ = 0, until_ns_ = 0;
};

}  // namespace whirl
