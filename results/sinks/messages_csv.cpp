// messages.csv: everything that crossed, a line each, with the names of its fields.
#include <cstdio>

#include "io_bridges/messages/fields.hpp"
#include "results/sinks/sink_types.hpp"

namespace whirl::results {
namespace {

// As RFC 4180 wants a text that may hold anything.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::string entry(const std::vector<std::string>& names, std::size_t number) {
  return number < names.size() ? names[number] : "";
}

// The pin, device or function that its number stands for; empty: none.
std::string thing_of(const io::Reader& message, const NodeHead& node) {
  switch (message.header().kind) {
    case io::Kind::pin_edge:
      return entry(node.pins, message.header().port);
    case io::Kind::data_ready:
      return entry(node.devices, message.header().port);
    case io::Kind::spi_transaction:
      return entry(node.devices, message.as<io::BusTransaction>().address);
    case io::Kind::function_call:
      return entry(node.watch, message.header().port);
    default:
      return "";
  }
}

class MessagesCsv : public Sink {
 public:
  explicit MessagesCsv(const SinkSetup& setup)
      : out_(setup.folder + "/messages.csv"), nodes_(setup.head.nodes) {
    out_.write("t_s,board,to_board,kind,port,of,fields\n");
  }

  void on_message(const io::Reader& message) override {
    const io::Header& header = message.header();
    const io::KindInfo* info = io::kind_info(header.kind);
    static constexpr io::KindInfo kUnknown{.kind = {}, .name = "unknown", .tail = io::Tail::bytes};
    if (info == nullptr) info = &kUnknown;
    char text[96];
    std::snprintf(text, sizeof text, "%.9f,", static_cast<double>(header.t_ns) * 1e-9);
    line_ = text;
    const NodeHead& node = nodes_[header.board];
    line_ += node.name;
    line_ += info->to_board ? ",1," : ",0,";
    line_.append(info->name);
    line_ += "," + std::to_string(header.port) + ",";
    const std::string of = thing_of(message, node);
    line_ += (of.empty() ? of : quoted(of)) + ",";
    line_ += quoted(io::fields_text(*info, message.payload())) + "\n";
    out_.write(line_);
  }

  std::vector<Error> finish() override {
    std::vector<Error> lost;
    close(out_, lost);
    return lost;
  }

 private:
  OutputFile out_;
  std::vector<NodeHead> nodes_;
  std::string line_;
};

}  // namespace

const SinkType kMessages_csv{"csv", "messages.csv", false, make_sink<MessagesCsv>};

}  // namespace whirl::results
