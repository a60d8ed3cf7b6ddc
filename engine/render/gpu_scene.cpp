// Uploads a scene, and keeps its per-frame data up to date.
#include "engine/render/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_precision.hpp>

#include "engine/base/error.h"
#include "engine/scene/animation.h"
#include "engine/vulkan/commands.h"

namespace gnomon {
namespace {

template <class T>
std::span<const std::byte> bytes_of(const std::vector<T>& values) {
  return std::as_bytes(std::span(values));
}

template <class T>
void write(const Buffer& buffer, const std::vector<T>& values) {
  std::memcpy(buffer.bytes().data(), values.data(), values.size() * sizeof(T));
}

uint16_t unorm16(float value) { return uint16_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 65535.0f)); }

VertexAttributes attributes_at(const Mesh& mesh, size_t i) {
  VertexAttributes a{};
  const glm::i16vec2 normal = octahedral_snorm16(mesh.normals[i]);
  a.normal[0] = normal.x, a.normal[1] = normal.y;
  a.uv[0] = mesh.uvs[i].x, a.uv[1] = mesh.uvs[i].y;
  const glm::vec4 color = mesh.colors.empty() ? glm::vec4(1.0f) : mesh.colors[i];
  for (int c = 0; c < 4; ++c) a.color[c] = unorm16(color[c]);
  return a;
}

// Geometric normal of a triangle, in double: slivers keep theirs.
glm::vec3 triangle_normal(const Mesh& mesh, size_t triangle) {
  const uint32_t* i = &mesh.indices[3 * triangle];
  const glm::dvec3 a = mesh.positions[i[0]], b = mesh.positions[i[1]], c = mesh.positions[i[2]];
  return glm::normalize(glm::cross(b - a, c - a));
}

Handle<VkDescriptorSetLayout> make_layout(const std::shared_ptr<Device>& device,
                                          const std::vector<VkDescriptorSetLayoutBinding>& bindings) {
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.bindingCount = uint32_t(bindings.size());
  info.pBindings = bindings.data();
  return create(device, vkCreateDescriptorSetLayout, info, vkDestroyDescriptorSetLayout,
                "vkCreateDescriptorSetLayout");
}

GpuImage upload_texture(const std::shared_ptr<Device>& device, const Texture& texture) {
  GpuImage image(device, {{texture.width, texture.height}, 1, 1, VK_FORMAT_R8G8B8A8_SRGB},
                 VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  Buffer staging(device, texture.rgba.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Place::host);
  std::memcpy(staging.bytes().data(), texture.rgba.data(), texture.rgba.size());
  OneShot once(device);
  change_layout(once.commands(), image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {texture.width, texture.height, 1};
  vkCmdCopyBufferToImage(once.commands(), staging.handle(), image.handle(),
                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
  change_layout(once.commands(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  once.submit_and_wait();
  return image;
}

VkSamplerAddressMode address_mode(Wrap wrap) {
  if (wrap == Wrap::clamp) return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  return wrap == Wrap::mirror ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT : VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

Handle<VkSampler> make_sampler(const std::shared_ptr<Device>& device, const Texture& texture) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = texture.nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.addressModeU = address_mode(texture.wrap_u);
  info.addressModeV = address_mode(texture.wrap_v);
  return create(device, vkCreateSampler, info, vkDestroySampler, "vkCreateSampler");
}

bool is_mirrored(const glm::dmat4& transform) { return glm::determinant(glm::dmat3(transform)) < 0; }

bool same(const FrameView& a, const FrameView& b) {
  return a.camera == b.camera && a.width == b.width && a.height == b.height && a.reversed_z == b.reversed_z;
}

}  // namespace

glm::i16vec2 octahedral_snorm16(const glm::vec3& unit) {
  const float sum = std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z);
  glm::vec2 p(unit.x / sum, unit.y / sum);
  if (unit.z < 0) {
    const glm::vec2 fold((1 - std::abs(p.y)) * (p.x >= 0 ? 1 : -1),
                         (1 - std::abs(p.x)) * (p.y >= 0 ? 1 : -1));
    p = fold;
  }
  return {int16_t(std::lround(p.x * 32767.0f)), int16_t(std::lround(p.y * 32767.0f))};
}

GpuScene::GpuScene(std::shared_ptr<Device> device, std::shared_ptr<const Scene> scene)
    : device_(std::move(device)),
      moving_(scene->animation ? std::make_shared<Scene>(*scene) : nullptr),
      scene_(moving_ ? moving_ : std::move(scene)),
      lights_changed_(scene_->lights.size(), true) {
  upload_geometry();
  upload_textures();
  make_frame_set();
  make_material_sets();
}

void GpuScene::upload_geometry() {
  std::vector<glm::vec3> positions;
  std::vector<VertexAttributes> attributes;
  std::vector<uint32_t> indices;
  std::vector<glm::i16vec2> normals;
  for (const Mesh& mesh : scene_->meshes) {
    first_vertex_.push_back(uint32_t(positions.size()));
    first_triangle_.push_back(uint32_t(normals.size()));
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (size_t i = 0; i < mesh.positions.size(); ++i) attributes.push_back(attributes_at(mesh, i));
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    for (size_t t = 0; t < mesh.triangles(); ++t)
      normals.push_back(octahedral_snorm16(triangle_normal(mesh, t)));
  }
  for (uint32_t i = 0; i < scene_->instances.size(); ++i) {
    const Instance& instance = scene_->instances[i];
    const Mesh& mesh = scene_->meshes[instance.mesh];
    const Material& material = scene_->materials[mesh.material];
    draws_.push_back({3 * first_triangle_[instance.mesh], uint32_t(mesh.indices.size()),
                      int32_t(first_vertex_[instance.mesh]), i, mesh.material, material.double_sided,
                      material.alpha_masked, is_mirrored(instance.world_from_object), mesh.watertight});
  }
  constexpr VkBufferUsageFlags kStorage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  positions_ = upload_buffer(device_, bytes_of(positions), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | kStorage);
  attributes_ = upload_buffer(device_, bytes_of(attributes), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  indices_ = upload_buffer(device_, bytes_of(indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT | kStorage);
  triangle_normals_ = upload_buffer(device_, bytes_of(normals), kStorage);
  materials_ = upload_buffer(device_, bytes_of(material_data(*scene_)), kStorage);
}

void GpuScene::upload_textures() {
  for (const Texture& texture : scene_->textures) {
    textures_.push_back(upload_texture(device_, texture));
    samplers_.push_back(make_sampler(device_, texture));
  }
  Texture white;
  white.rgba = {255, 255, 255, 255};
  textures_.push_back(upload_texture(device_, white));
  samplers_.push_back(make_sampler(device_, white));
}

void GpuScene::make_frame_set() {
  const auto host = [&](size_t count, size_t stride, VkBufferUsageFlags usage) {
    return Buffer(device_, std::max<uint64_t>(count * stride, 16), usage, Place::host);
  };
  frame_buffer_ = host(1, sizeof(FrameData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  lights_ = host(scene_->lights.size(), sizeof(LightData), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  instances_ = host(scene_->instances.size(), sizeof(InstanceData), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);

  const Buffer* buffers[] = {&frame_buffer_,     &lights_,    &instances_, &materials_,
                             &triangle_normals_, &positions_, &indices_};
  constexpr uint32_t kUniformBuffers = 2;  // frame, lights; storage buffers follow
  const uint64_t most = device_->limits().maxUniformBufferRange;
  if (lights_.size() > most)
    fail(fmt::format("{} lights are more than '{}' can hold", scene_->lights.size(), device_->info().name),
         scene_->file.string());
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < std::size(buffers); ++i)
    bindings.push_back(
        {i, i < kUniformBuffers ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
         VK_SHADER_STAGE_ALL, nullptr});
  frame_layout_ = make_layout(device_, bindings);
  material_layout_ = make_layout(
      device_, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr}});
  const uint32_t materials = uint32_t(scene_->materials.size());
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kUniformBuffers},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 16},
                                        {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, materials}};
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.maxSets = 1 + materials;
  pool.poolSizeCount = uint32_t(std::size(sizes));
  pool.pPoolSizes = sizes;
  pool_ = create(device_, vkCreateDescriptorPool, pool, vkDestroyDescriptorPool, "vkCreateDescriptorPool");

  const VkDescriptorSetLayout layout = frame_layout();
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool_.get(),
                                       1, &layout};
  check(vkAllocateDescriptorSets(device_->handle(), &allocate, &frame_set_), "vkAllocateDescriptorSets");
  for (uint32_t i = 0; i < std::size(buffers); ++i) {
    VkDescriptorBufferInfo info{buffers[i]->handle(), 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, frame_set_, i, 0, 1};
    w.descriptorType = bindings[i].descriptorType;
    w.pBufferInfo = &info;
    vkUpdateDescriptorSets(device_->handle(), 1, &w, 0, nullptr);
  }
}

void GpuScene::make_material_sets() {
  for (const Material& material : scene_->materials) {
    const uint32_t texture = material.base_color_texture.value_or(uint32_t(textures_.size() - 1));
    const VkDescriptorSetLayout layout = material_layout();
    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool_.get(),
                                         1, &layout};
    VkDescriptorSet set = VK_NULL_HANDLE;
    check(vkAllocateDescriptorSets(device_->handle(), &allocate, &set), "vkAllocateDescriptorSets");
    VkDescriptorImageInfo info{samplers_[texture].get(), textures_[texture].sampled_view(false),
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set, 0, 0, 1};
    w.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    w.pImageInfo = &info;
    vkUpdateDescriptorSets(device_->handle(), 1, &w, 0, nullptr);
    material_sets_.push_back(set);
  }
}

// Moves the scene and notes what has moved.
void GpuScene::pose(double seconds, bool first) {
  casters_changed_ = first;
  lights_changed_.assign(lights_changed_.size(), first);
  if (!moving_) return;
  const Pose pose = pose_at(*moving_, seconds);
  for (size_t i = 0; i < pose.instances.size(); ++i) {
    casters_changed_ = casters_changed_ || pose.instances[i] != moving_->instances[i].world_from_object;
    draws_[i].mirrored = is_mirrored(pose.instances[i]);
  }
  for (size_t i = 0; i < pose.lights.size(); ++i)
    if (pose.lights[i] != moving_->lights[i].world_from_light) lights_changed_[i] = true;
  apply(pose, *moving_);
}

void GpuScene::update(const FrameView& view, double seconds, uint32_t frame_index) {
  const bool first = frame_index == 0;
  pose(seconds, first);
  const auto any_light = [this] {
    return std::find(lights_changed_.begin(), lights_changed_.end(), true) != lights_changed_.end();
  };

  const Camera& camera = scene_->cameras.at(view.camera);
  const Camera& previous = first ? camera : camera_;
  const glm::dvec3 eye(camera.world_from_camera[3]);
  const bool eye_moved = first || eye != glm::dvec3(previous.world_from_camera[3]);
  camera_changed_ = first || camera.world_from_camera != previous.world_from_camera || !same(view, view_);
  frame_ = frame_data(camera, previous, view.width, view.height, view.reversed_z,
                      uint32_t(scene_->lights.size()), frame_index);
  std::memcpy(frame_buffer_.bytes().data(), &frame_, sizeof(frame_));
  if (eye_moved || any_light()) {  // positions are relative to the eye
    write(lights_, light_data(*scene_, eye));
  }
  if (eye_moved || casters_changed_) write(instances_, instance_data(*scene_, first_triangle_, eye));
  camera_ = camera;
  view_ = view;
}

}  // namespace gnomon
