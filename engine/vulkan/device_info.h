// Devices as their users know them: names, choice, messages. No Vulkan here.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

class Device;  // engine/vulkan/device.h

struct DeviceInfo {
  std::string name, driver;
  bool is_cpu = false;
};
struct DeviceOptions {
  std::string name_part;  // part of the device's name, any case; empty: a GPU if there is one, else lavapipe
  bool validation =
      false;             // validation and synchronisation-validation layers; see Device::validation_messages
  bool thrifty = false;  // as if the device had no feature that can be done without
};
std::shared_ptr<Device> open_device(const DeviceOptions& options);  // Error: no Vulkan device, no such name
std::vector<DeviceInfo> list_devices();
const DeviceInfo& device_info(const Device& device);
const std::vector<std::string>& validation_messages(const Device& device);

}  // namespace gnomon
