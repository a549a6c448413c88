// messages.csv: everything that crossed, a line each, with the names of its fields.
#include <cstdio>

#include "base/output_file.hpp"
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

class MessagesCsv : public Sink {
 public:
  explicit MessagesCsv(const SinkSetup& setup) : out_(setup.folder + "/messages.csv") {
    for (const NodeHead& node : setup.head.nodes) nodes_.push_back(node.name);
    out_.write("t_s,board,to_board,kind,port,fields\n");
  }

  void on_message(const io::Reader& message) override {
    const io::Header& header = message.header();
    const io::KindInfo* info = io::kind_info(header.kind);
    static constexpr io::KindInfo kUnknown{.kind = {}, .name = "unknown", .tail = io::Tail::bytes};
    if (info == nullptr) info = &kUnknown;
    char text[96];
    std::snprintf(text, sizeof text, "%.9f,", static_cast<double>(header.t_ns) * 1e-9);
    line_ = text;
    line_ += nodes_[header.board];
    line_ += info->to_board ? ",1," : ",0,";
    line_.append(info->name);
    line_ += "," + std::to_string(header.port) + ",";
    line_ += quoted(io::fields_text(*info, message.payload())) + "\n";
    out_.write(line_);
  }

  std::vector<Error> finish() override {
    if (const auto closed = out_.close(); !closed) return {closed.error()};
    return {};
  }

 private:
  OutputFile out_;
  std::vector<std::string> nodes_;
  std::string line_;
};

}  // namespace

const SinkType kMessages_csv{"csv", "messages.csv", false,
                             [](const SinkSetup& setup) -> std::unique_ptr<Sink> {
                               return std::make_unique<MessagesCsv>(setup);
                             }};

}  // namespace whirl::results
