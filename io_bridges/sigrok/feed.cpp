#include "io_bridges/sigrok/feed.hpp"

#include <vector>

namespace whirl::sigrok {

std::string own_name(const std::string& channel) {
  return channel.substr(channel.rfind('.') + 1);
}

void feed_callback(const sr_dev_inst* device, const sr_datafeed_packet* packet, void* feed) {
  static_cast<Feed*>(feed)->on_packet(device, packet);
}

void Feed::begin(const sr_dev_inst* device) {
  GVariant* rate = nullptr;
  if (rate_Hz <= 0.0 && sr_config_get(sr_dev_inst_driver_get(device), device, nullptr,
                                      SR_CONF_SAMPLERATE, &rate) == SR_OK) {
    rate_Hz = static_cast<double>(g_variant_get_uint64(rate));
    g_variant_unref(rate);
  }
  if (rate_Hz <= 0.0) {
    error = Error{ErrorKind::bad_input, "", "states no sample rate", ""};
    return;
  }
  std::vector<std::string> channels;
  std::vector<int> bits;
  for (GSList* at = sr_dev_inst_channels_get(device); at != nullptr; at = at->next) {
    const auto* channel = static_cast<const sr_channel*>(at->data);
    if (channel->type != SR_CHANNEL_LOGIC) continue;
    const auto named = names.find(own_name(channel->name));
    if (named == names.end() && only_named) continue;
    channels.push_back(named == names.end() ? own_name(channel->name) : named->second);
    bits.push_back(channel->index);
  }
  sink.begin(channels, rate_Hz);
  reader.emplace(std::move(bits), rate_Hz, sink);
}

void Feed::on_packet(const sr_dev_inst* device, const sr_datafeed_packet* packet) {
  if (error) return;
  if (packet->type == SR_DF_META) {
    const auto* meta = static_cast<const sr_datafeed_meta*>(packet->payload);
    for (GSList* at = meta->config; at != nullptr; at = at->next) {
      const auto* config = static_cast<const sr_config*>(at->data);
      if (config->key != SR_CONF_SAMPLERATE) continue;
      rate_Hz = static_cast<double>(g_variant_get_uint64(config->data));
    }
  }
  if (packet->type != SR_DF_LOGIC) return;
  const auto* logic = static_cast<const sr_datafeed_logic*>(packet->payload);
  if (!reader) begin(device);
  if (error || logic->unitsize == 0) return;
  reader->add({static_cast<const std::uint8_t*>(logic->data), logic->length}, logic->unitsize);
}

}  // namespace whirl::sigrok
