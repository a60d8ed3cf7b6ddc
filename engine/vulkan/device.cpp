// Opens a Vulkan device: picks one, checks its features, makes its queue.
#include "engine/vulkan/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include "engine/base/error.h"
#include "engine/vulkan/pipeline_store.h"

namespace gnomon {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr size_t kPipelinesKept = 64;  // several techniques with all their variants
constexpr const char* kNoDeviceHint =
    "install a Vulkan driver; without a GPU, Mesa's lavapipe (Debian: mesa-vulkan-drivers)";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT type,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  // Loader notes about drivers that are not there are no fault of ours.
  if (type == VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT) return VK_FALSE;
  static_cast<Device*>(user)->add_message(data->pMessage);
  return VK_FALSE;
}

bool has_layer(const char* name) {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(),
                     [&](const auto& l) { return !std::strcmp(l.layerName, name); });
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
  uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vkEnumeratePhysicalDevices(instance, &count, devices.data());
  devices.resize(count);
  return devices;
}

DeviceInfo info_of(VkPhysicalDevice physical) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  return {properties.properties.deviceName, fmt::format("{} {}", driver.driverName, driver.driverInfo),
          properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU};
}

bool usable(VkPhysicalDevice physical) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  return properties.apiVersion >= VK_API_VERSION_1_3;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

VkInstance bare_instance() {
  if (volkInitialize() != VK_SUCCESS) fail("no Vulkan loader on this machine", {}, {}, kNoDeviceHint);
  VkApplicationInfo app{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "gnomon", 1, "gnomon", 1, VK_API_VERSION_1_3};
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &app;
  VkInstance instance = VK_NULL_HANDLE;
  if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS)
    fail("no Vulkan driver on this machine", {}, {}, kNoDeviceHint);
  volkLoadInstanceOnly(instance);
  return instance;
}

struct ResultName {
  VkResult result;
  const char *name, *what;
};
constexpr ResultName kResults[] = {
    {VK_ERROR_INITIALIZATION_FAILED, "VK_ERROR_INITIALIZATION_FAILED", "the driver cannot begin"},
    {VK_ERROR_DEVICE_LOST, "VK_ERROR_DEVICE_LOST", "the device is lost: it crashed or took too long"},
    {VK_ERROR_MEMORY_MAP_FAILED, "VK_ERROR_MEMORY_MAP_FAILED", "the device's memory cannot be mapped"},
    {VK_ERROR_LAYER_NOT_PRESENT, "VK_ERROR_LAYER_NOT_PRESENT", "a layer is not installed"},
    {VK_ERROR_EXTENSION_NOT_PRESENT, "VK_ERROR_EXTENSION_NOT_PRESENT", "an extension is missing"},
    {VK_ERROR_FEATURE_NOT_PRESENT, "VK_ERROR_FEATURE_NOT_PRESENT", "a feature is missing"},
    {VK_ERROR_INCOMPATIBLE_DRIVER, "VK_ERROR_INCOMPATIBLE_DRIVER", "the driver is too old"},
    {VK_ERROR_TOO_MANY_OBJECTS, "VK_ERROR_TOO_MANY_OBJECTS", "there are too many objects of this kind"},
    {VK_ERROR_FORMAT_NOT_SUPPORTED, "VK_ERROR_FORMAT_NOT_SUPPORTED", "the device has no such format"},
    {VK_ERROR_FRAGMENTED_POOL, "VK_ERROR_FRAGMENTED_POOL", "a pool is fragmented"},
    {VK_ERROR_OUT_OF_POOL_MEMORY, "VK_ERROR_OUT_OF_POOL_MEMORY", "a pool is exhausted"},
    {VK_ERROR_UNKNOWN, "VK_ERROR_UNKNOWN", "the driver refuses without a reason"}};

}  // namespace

void check(VkResult result, const char* call) {
  if (result >= 0) return;
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    fail(fmt::format("out of memory in {}", call), {}, {}, "use a smaller --size or shadow map");
  for (const auto& [known, name, what] : kResults)
    if (known == result)
      fail(fmt::format("{}: {} ({})", call, what, name), {}, {}, "another --device may do");
  fail(fmt::format("{}: the driver fails with the unknown result {}", call, int(result)), {}, {},
       "another --device may do");
}

Device::Device(const DeviceOptions& options) {
  try {
    make_instance(options.validation);
    choose_physical(options.name_part);
    make_device(options.thrifty);
  } catch (...) {
    destroy();
    throw;
  }
}

Device::~Device() { destroy(); }

void Device::destroy() {
  pipelines_.reset();
  if (device_) vkDestroyDevice(device_, nullptr);
  if (messenger_) destroy_messenger_(instance_, messenger_, nullptr);
  if (instance_) vkDestroyInstance(instance_, nullptr);
  device_ = VK_NULL_HANDLE, messenger_ = VK_NULL_HANDLE, instance_ = VK_NULL_HANDLE;
}

void Device::add_message(std::string text) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(text));
}

void Device::count_memory(int64_t bytes) {
  bytes_ += bytes;
  peak_bytes_ = std::max(peak_bytes_, bytes_);
}

void Device::make_instance(bool validation) {
  if (volkInitialize() != VK_SUCCESS) fail("no Vulkan loader on this machine", {}, {}, kNoDeviceHint);
  if (validation && !has_layer(kValidationLayer))
    fail("the Vulkan validation layer is not installed", {}, {}, "Debian: vulkan-validationlayers");
  VkApplicationInfo app{
      VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "gnomon", 1, "gnomon", 1, VK_API_VERSION_1_3};
  const VkValidationFeatureEnableEXT enabled[] = {
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = enabled;
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &app;
  if (validation) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
  }
  if (vkCreateInstance(&info, nullptr, &instance_) != VK_SUCCESS)
    fail("no Vulkan driver on this machine", {}, {}, kNoDeviceHint);
  // Functions are taken through the instance, so that several devices can live side by side.
  volkLoadInstance(instance_);
  if (!validation) return;
  VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                          VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                          VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  messenger.pfnUserCallback = on_message;
  messenger.pUserData = this;
  destroy_messenger_ = vkDestroyDebugUtilsMessengerEXT;
  check(vkCreateDebugUtilsMessengerEXT(instance_, &messenger, nullptr, &messenger_),
        "vkCreateDebugUtilsMessengerEXT");
}

void Device::choose_physical(const std::string& name_part) {
  auto devices = physical_devices(instance_);
  std::erase_if(devices, [](VkPhysicalDevice d) { return !usable(d); });
  if (devices.empty()) fail("no Vulkan 1.3 device on this machine", {}, {}, kNoDeviceHint);
  std::string wanted = lower(name_part);
  if (wanted == "lavapipe") wanted = "llvmpipe";  // Mesa's name for the same device
  std::stable_sort(devices.begin(), devices.end(), [](VkPhysicalDevice a, VkPhysicalDevice b) {
    return !info_of(a).is_cpu && info_of(b).is_cpu;
  });
  for (VkPhysicalDevice candidate : devices) {
    if (lower(info_of(candidate).name).find(wanted) == std::string::npos) continue;
    physical_ = candidate;
    break;
  }
  if (!physical_) {
    std::string names;
    for (VkPhysicalDevice d : devices) names += (names.empty() ? "" : ", ") + info_of(d).name;
    fail(fmt::format("no Vulkan device has '{}' in its name", name_part), {}, "--device",
         "there is: " + names);
  }
  info_ = info_of(physical_);
  vkGetPhysicalDeviceProperties(physical_, &properties_);
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

// All that is missing at once.
void Device::check_features(bool thrifty) {
  VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &f13};
  VkPhysicalDeviceFeatures2 asked{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f12, {}};
  vkGetPhysicalDeviceFeatures2(physical_, &asked);
  const VkPhysicalDeviceFeatures& f10 = asked.features;
  VkPhysicalDeviceVulkan13Properties sizes{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties subgroups{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
                                               &sizes};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &subgroups, {}};
  vkGetPhysicalDeviceProperties2(physical_, &properties);
  subgroup_size_ = subgroups.subgroupSize;
  chooses_layers_ = f12.shaderOutputLayer == VK_TRUE && !thrifty;
  numbers_triangles_ = f10.geometryShader == VK_TRUE && !thrifty;
  const bool shuffles = subgroups.subgroupSupportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  const struct {
    bool there;
    const char* what;
  } needed[] = {
      {f10.depthClamp == VK_TRUE, "depthClamp"},
      {f10.occlusionQueryPrecise == VK_TRUE, "occlusionQueryPrecise"},
      {f10.fragmentStoresAndAtomics == VK_TRUE, "fragmentStoresAndAtomics"},
      {f10.shaderClipDistance == VK_TRUE, "shaderClipDistance"},
      {f10.independentBlend == VK_TRUE, "independentBlend"},
      {f10.imageCubeArray == VK_TRUE, "imageCubeArray"},
      {f13.synchronization2 == VK_TRUE, "synchronization2"},
      {f13.dynamicRendering == VK_TRUE, "dynamicRendering"},
      {f13.maintenance4 == VK_TRUE, "maintenance4"},
      {f13.subgroupSizeControl == VK_TRUE, "subgroupSizeControl"},
      {shuffles && subgroup_size_ >= 4, "subgroups of 4 invocations or more that shuffle"},
      {(sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0,
       "compute in requiredSubgroupSizeStages"},
  };
  std::string missing;
  for (const auto& one : needed)
    if (!one.there) missing += (missing.empty() ? "" : ", ") + std::string(one.what);
  if (!missing.empty())
    fail(fmt::format("'{}' lacks what Gnomon needs: {}", info_.name, missing), {}, {},
         "choose another device (gnomon list devices)");
}

void Device::make_device(bool thrifty) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  while (queue_family_ < count && (families[queue_family_].queueFlags & kNeeded) != kNeeded) ++queue_family_;
  if (queue_family_ == count) fail(fmt::format("'{}' has no queue for graphics and compute", info_.name));

  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  check_features(thrifty);

  VkPhysicalDeviceVulkan12Features f12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  f12.shaderOutputLayer = chooses_layers_ ? VK_TRUE : VK_FALSE;
  VkPhysicalDeviceVulkan13Features f13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, &f12};
  f13.synchronization2 = f13.dynamicRendering = f13.maintenance4 = f13.subgroupSizeControl = VK_TRUE;
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &f13, {}};
  features.features.geometryShader = numbers_triangles_ ? VK_TRUE : VK_FALSE;  // gl_PrimitiveID
  features.features.depthClamp = VK_TRUE;
  features.features.occlusionQueryPrecise = VK_TRUE;
  features.features.fragmentStoresAndAtomics = VK_TRUE;
  features.features.shaderClipDistance = VK_TRUE;
  features.features.independentBlend = VK_TRUE;
  features.features.imageCubeArray = VK_TRUE;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  check(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  pipelines_ = std::make_unique<PipelineStore>(device_, kPipelinesKept);
}

uint32_t Device::memory_type(uint32_t type_bits, VkMemoryPropertyFlags wanted) const {
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
    if ((type_bits >> i & 1) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  fail(fmt::format("'{}' has no memory type for a resource", info_.name));
}

uint32_t Device::memory_type(uint32_t type_bits, VkMemoryPropertyFlags wanted,
                             VkMemoryPropertyFlags preferred) const {
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
    if ((type_bits >> i & 1) &&
        (memory_.memoryTypes[i].propertyFlags & (wanted | preferred)) == (wanted | preferred))
      return i;
  return memory_type(type_bits, wanted);
}

std::shared_ptr<Device> open_device(const DeviceOptions& options) {
  return std::make_shared<Device>(options);
}

std::vector<DeviceInfo> list_devices() {
  VkInstance instance = bare_instance();
  std::vector<DeviceInfo> infos;
  for (VkPhysicalDevice d : physical_devices(instance))
    if (usable(d)) infos.push_back(info_of(d));
  vkDestroyInstance(instance, nullptr);
  return infos;
}

const DeviceInfo& device_info(const Device& device) { return device.info(); }
const std::vector<std::string>& validation_messages(const Device& device) { return device.messages(); }

}  // namespace gnomon
