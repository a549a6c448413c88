// Logic analysers on this host.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <tuple>

#include "io_bridges/sigrok/capture.hpp"
#include "io_bridges/sigrok/context.hpp"
#include "io_bridges/sigrok/feed.hpp"

namespace whirl::sigrok {
namespace {

Error refused(const std::string& place, const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, place, what, cure};
}

sr_dev_driver* find_driver(const Context& context, const std::string& name) {
  for (sr_dev_driver** at = sr_driver_list(context.get()); at != nullptr && *at != nullptr; ++at) {
    if (name == (*at)->name) return *at;
  }
  return nullptr;
}

std::string text_of(const char* text) {
  return text == nullptr ? "" : text;
}

std::string called(const sr_dev_inst* device) {
  std::string all = text_of(sr_dev_inst_vendor_get(device));
  for (const char* part : {sr_dev_inst_model_get(device), sr_dev_inst_version_get(device)}) {
    if (part != nullptr && *part != '\0') all += (all.empty() ? "" : " ") + std::string(part);
  }
  return all.empty() ? "a device without a name" : all;
}

// The first that is of the model; null, and what was there instead.
sr_dev_inst* choose(sr_dev_driver* driver, const DeviceOptions& options, std::string& others) {
  GSList* wanted = nullptr;
  sr_config connection{SR_CONF_CONN, nullptr};
  if (!options.connection.empty()) {
    connection.data = g_variant_ref_sink(g_variant_new_string(options.connection.c_str()));
    wanted = g_slist_append(nullptr, &connection);
  }
  GSList* found = sr_driver_scan(driver, wanted);
  sr_dev_inst* chosen = nullptr;
  for (GSList* at = found; at != nullptr && chosen == nullptr; at = at->next) {
    auto* device = static_cast<sr_dev_inst*>(at->data);
    const std::string name = called(device);
    if (name.find(options.model) != std::string::npos) chosen = device;
    if (chosen == nullptr) others += (others.empty() ? "" : ", ") + name;
  }
  g_slist_free(found);
  g_slist_free(wanted);
  if (connection.data != nullptr) g_variant_unref(connection.data);
  return chosen;
}

// Those that are named are looked at, and no others.
Result<Done> set_channels(sr_dev_inst* device, const DeviceOptions& options,
                          const std::string& place) {
  Renamed missing = options.names;
  std::string there;
  for (GSList* at = sr_dev_inst_channels_get(device); at != nullptr; at = at->next) {
    auto* channel = static_cast<sr_channel*>(at->data);
    const bool logic = channel->type == SR_CHANNEL_LOGIC;
    const bool named = logic && missing.erase(channel->name) > 0;
    sr_dev_channel_enable(channel, named ? TRUE : FALSE);
    if (logic) there += (there.empty() ? "" : ", ") + std::string(channel->name);
  }
  if (missing.empty()) return Done{};
  return refused(place, "has no channel '" + missing.begin()->first + "'", "it has " + there);
}

Result<Done> set_rate(sr_dev_inst* device, double rate_Hz, const std::string& place) {
  GVariant* rate = g_variant_new_uint64(static_cast<std::uint64_t>(rate_Hz));
  if (sr_config_set(device, nullptr, SR_CONF_SAMPLERATE, rate) == SR_OK) return Done{};
  return refused(place,
                 "does not sample at " + std::to_string(static_cast<long long>(rate_Hz)) + " Hz",
                 "sigrok-cli --driver ... --show lists its rates");
}

}  // namespace

Error no_device(const std::string& place, const std::string& said) {
  const auto has = [&](const char* word) { return said.find(word) != std::string::npos; };
  if (has("ACCESS") || has("ermission") || has("nsufficient")) {
    return refused(place, "may not be opened: " + said,
                   "Debian's udev rules are in libsigrok4; the user belongs into group plugdev");
  }
  if (has("BUSY") || has("busy") || has("in use")) {
    return refused(place, "is busy: " + said, "who else has it open? PulseView, sigrok-cli?");
  }
  return refused(place, "cannot be opened" + (said.empty() ? "" : ": " + said));
}

struct Device::Inner {
  Context context;
  DeviceOptions options;
  sr_dev_inst* device = nullptr;
  std::string name;
  std::string place;
  Session session;
  std::atomic<bool> stopping = false;

  ~Inner() {
    session.reset();
    if (device != nullptr) sr_dev_close(device);
  }
};

Device::Device(std::unique_ptr<Inner> inner) : inner_(std::move(inner)) {}
Device::~Device() = default;

Result<std::unique_ptr<Device>> Device::open(const DeviceOptions& options) {
  auto inner = std::make_unique<Inner>();
  inner->options = options;
  inner->place = options.driver + (options.connection.empty() ? "" : ":conn=" + options.connection);
  sr_dev_driver* driver = find_driver(inner->context, options.driver);
  if (driver == nullptr) {
    return refused(inner->place, "libsigrok has no driver '" + options.driver + "'",
                   "sigrok-cli --list-supported lists them");
  }
  std::ignore = Context::last_complaint();
  if (sr_driver_init(inner->context.get(), driver) != SR_OK) {
    return no_device(inner->place, Context::last_complaint());
  }
  std::string others;
  sr_dev_inst* device = choose(driver, options, others);
  if (device == nullptr && !others.empty()) {
    return refused(inner->place, "is not '" + options.model + "' but " + others);
  }
  if (device == nullptr) {
    const std::string said = Context::last_complaint();
    if (!said.empty()) return no_device(inner->place, said);
    return refused(inner->place, "no analyser is there",
                   "is it plugged in? sigrok-cli --scan lists them");
  }
  if (sr_dev_open(device) != SR_OK) return no_device(inner->place, Context::last_complaint());
  inner->device = device;
  inner->name = called(device);
  if (const auto set = set_channels(device, options, inner->place); !set) return set.error();
  if (const auto set = set_rate(device, options.rate_Hz, inner->place); !set) return set.error();
  GVariant* on = g_variant_new_boolean(TRUE);
  std::ignore = sr_config_set(device, nullptr, SR_CONF_CONTINUOUS, on);  // those that know it
  sr_session* made = nullptr;
  if (sr_session_new(inner->context.get(), &made) != SR_OK) {
    return Error{ErrorKind::internal, inner->place, "libsigrok makes no session", ""};
  }
  inner->session.reset(made);
  return std::unique_ptr<Device>(new Device(std::move(inner)));
}

std::string Device::version() const {
  return inner_->name + ", libsigrok " + sr_package_version_string_get();
}

Result<Done> Device::run(copper::EdgeSink& sink) {
  sr_session* session = inner_->session.get();
  Feed feed{.names = inner_->options.names,
            .only_named = true,
            .sink = sink,
            .rate_Hz = inner_->options.rate_Hz};
  sr_session_datafeed_callback_add(session, feed_callback, &feed);
  const bool ran = sr_session_dev_add(session, inner_->device) == SR_OK &&
                   sr_session_start(session) == SR_OK && sr_session_run(session) == SR_OK;
  if (feed.error) return *feed.error;
  if (ran && inner_->stopping) return Done{};
  const std::string said = Context::last_complaint();
  return Error{ErrorKind::host, inner_->place,
               "the analyser stopped by itself" + (said.empty() ? "" : ": " + said), ""};
}

void Device::stop() {
  inner_->stopping = true;
  sr_session_stop(inner_->session.get());
}

}  // namespace whirl::sigrok
