#include "results/sinks/replay.hpp"

#include "results/messages/message_file.hpp"

namespace whirl::results {
namespace {

void pour(MessageReader& reader, const std::vector<Sink*>& sinks, Replayed& done) {
  for (;;) {
    const auto next = reader.next();
    if (!next) {
      done.damage = next.error();
      return;
    }
    const io::Reader& message = reader.message();
    switch (next.value()) {
      case MessageReader::Next::end:
        return;
      case MessageReader::Next::row:
        ++done.rows;
        done.end_ns = message.header().t_ns;
        for (Sink* sink : sinks) sink->on_row(message.header().t_ns, reader.row());
        break;
      case MessageReader::Next::message:
        for (Sink* sink : sinks) sink->on_message(message);
        break;
    }
  }
}

}  // namespace

Result<Replayed> look_through(const std::string& messages) {
  auto reader = MessageReader::open(messages);
  if (!reader) return reader.error();
  Replayed done;
  pour(reader.value(), {}, done);
  done.whole = reader.value().rows().has_value() && !done.damage;
  return done;
}

Result<Replayed> replay(const std::string& messages, const std::string& folder,
                        const std::vector<SinkType>& types, const std::vector<Sink*>& others) {
  auto reader = MessageReader::open(messages);
  if (!reader) return reader.error();
  Replayed done;
  const std::optional<std::uint64_t> stated = reader.value().rows();
  // Of a run that was cut off nobody wrote down how many rows there are.
  std::uint64_t rows = stated.value_or(0);
  if (!stated) {
    const auto counted = look_through(messages);
    if (!counted) return counted.error();
    rows = counted.value().rows;
  }
  std::vector<std::unique_ptr<Sink>> made;
  std::vector<Sink*> sinks = others;
  for (const SinkType& type : types) {
    made.push_back(type.make({reader.value().head(), folder, rows}));
    sinks.push_back(made.back().get());
  }
  pour(reader.value(), sinks, done);
  done.whole = stated.has_value() && !done.damage;
  for (Sink* sink : sinks) {
    for (Error& lost : sink->finish()) done.lost.push_back(std::move(lost));
  }
  return done;
}

}  // namespace whirl::results
