// Keeps the pipelines that a device made last.
#include "engine/vulkan/pipeline_store.h"

#include <algorithm>

namespace gnomon {

PipelineStore::Held PipelineStore::get(const std::string& key, const std::function<VkPipeline()>& make) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
  if (found != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, found);
    return found->pipeline;
  }
  const VkDevice device = device_;
  const Held made(new VkPipeline(make()), [device](const VkPipeline* pipeline) {
    vkDestroyPipeline(device, *pipeline, nullptr);
    delete pipeline;
  });
  entries_.push_front({key, made});
  if (entries_.size() > most_) entries_.pop_back();
  return made;
}

}  // namespace gnomon
