// The pipelines that a device made last, so that renderers that use the same shaders share them: making one
// takes longer than drawing with it, above all on software devices.
#pragma once

#include <volk.h>

#include <functional>
#include <list>
#include <memory>
#include <string>

namespace gnomon {

class PipelineStore {
 public:
  // A pipeline that lives as long as somebody holds it. Its device must live longer.
  using Held = std::shared_ptr<const VkPipeline>;

  PipelineStore(VkDevice device, size_t most) : device_(device), most_(most) {}
  // The pipeline of `key`: all that it is made of, its layout included. `make` is asked when none is there;
  // of more than `most` pipelines the one used longest ago is forgotten.
  Held get(const std::string& key, const std::function<VkPipeline()>& make);

 private:
  struct Entry {
    std::string key;
    Held pipeline;
  };
  VkDevice device_;
  size_t most_;
  std::list<Entry> entries_;  // the one used last in front
};

}  // namespace gnomon
