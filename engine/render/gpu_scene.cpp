// Uploads a scene, and keeps its per-frame data up to date.
#include "engine/render/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_precision.hpp>

#include "engine/base/error.h"
#include "engine/scene/animation.h"
#include "engine/scene/camera.h"
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

// Geometric normal of a triangle, in double: slivers keep theirs. One without area, which only a shape that
// changes has, is never seen.
glm::vec3 triangle_normal(const Mesh& mesh, size_t triangle) {
  const uint32_t* i = &mesh.indices[3 * triangle];
  const glm::dvec3 a = mesh.positions[i[0]], b = mesh.positions[i[1]], c = mesh.positions[i[2]];
  const glm::dvec3 n = glm::cross(b - a, c - a);
  return glm::dot(n, n) > 0 ? glm::normalize(n) : glm::dvec3(0, 1, 0);
}

std::vector<VertexAttributes> attributes_of(const Mesh& mesh) {
  std::vector<VertexAttributes> result;
  for (size_t i = 0; i < mesh.positions.size(); ++i) result.push_back(attributes_at(mesh, i));
  return result;
}

std::vector<glm::i16vec2> normals_of(const Mesh& mesh) {
  std::vector<glm::i16vec2> result;
  for (size_t t = 0; t < mesh.triangles(); ++t)
    result.push_back(octahedral_snorm16(triangle_normal(mesh, t)));
  return result;
}

// Writes parts of device buffers, all at once.
class Rewrite {
 public:
  template <class T>
  void add(const Buffer& target, size_t first, const std::vector<T>& values) {
    if (values.empty()) return;
    const auto bytes = bytes_of(values);
    parts_.push_back({&target, {bytes_.size(), first * sizeof(T), bytes.size()}});
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  void run(const std::shared_ptr<Device>& device) const {
    if (parts_.empty()) return;
    const Buffer staging(device, bytes_.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Place::host);
    std::memcpy(staging.bytes().data(), bytes_.data(), bytes_.size());
    OneShot once(device);
    for (const Part& part : parts_)
      vkCmdCopyBuffer(once.commands(), staging.handle(), part.target->handle(), 1, &part.copy);
    VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT;
    vkCmdPipelineBarrier(once.commands(), VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         0, 1, &barrier, 0, nullptr, 0, nullptr);
    once.submit_and_wait();
  }

 private:
  struct Part {
    const Buffer* target;
    VkBufferCopy copy;
  };
  std::vector<Part> parts_;
  std::vector<std::byte> bytes_;
};

bool same(const Shape& shape, const Mesh& mesh) {
  return shape.positions == mesh.positions && shape.normals == mesh.normals;
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
    const std::vector<VertexAttributes> own = attributes_of(mesh);
    attributes.insert(attributes.end(), own.begin(), own.end());
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    const std::vector<glm::i16vec2> faces = normals_of(mesh);
    normals.insert(normals.end(), faces.begin(), faces.end());
  }
  for (uint32_t i = 0; i < scene_->instances.size(); ++i) {
    const Instance& instance = scene_->instances[i];
    const Mesh& mesh = scene_->meshes[instance.mesh];
    const Material& material = scene_->materials[mesh.material];
    draws_.push_back({3 * first_triangle_[instance.mesh], uint32_t(mesh.indices.size()),
                      int32_t(first_vertex_[instance.mesh]), i, mesh.material, material.double_sided,
                      material.alpha_masked, is_mirrored(instance.world_from_object), mesh.watertight,
                      !material.base_color_texture && mesh.colors.empty()});
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
    const Instance& instance = moving_->instances[i];
    casters_changed_ = casters_changed_ || pose.instances[i] != instance.world_from_object ||
                       pose.visible[i] != instance.visible;
    draws_[i].mirrored = is_mirrored(pose.instances[i]);
  }
  for (size_t i = 0; i < pose.lights.size(); ++i)
    if (pose.lights[i] != moving_->lights[i].world_from_light ||
        pose.intensities[i] != moving_->lights[i].intensity)
      lights_changed_[i] = true;
  for (const PosedMaterial& m : pose.materials)
    casters_changed_ = casters_changed_ || m.base_color != moving_->materials[m.material].base_color ||
                       m.alpha_cutoff != moving_->materials[m.material].alpha_cutoff;
  for (const PosedMesh& m : pose.meshes)
    casters_changed_ = casters_changed_ || !same(m.shape, moving_->meshes[m.mesh]);
  apply(pose, *moving_);
  if (casters_changed_) update_meshes(pose);
}

// What apply() has changed of meshes and materials.
void GpuScene::update_meshes(const Pose& pose) {
  Rewrite rewrite;
  for (const PosedMesh& posed : pose.meshes) {
    const Mesh& mesh = moving_->meshes[posed.mesh];
    rewrite.add(positions_, first_vertex_[posed.mesh], mesh.positions);
    rewrite.add(attributes_, first_vertex_[posed.mesh], attributes_of(mesh));
    rewrite.add(triangle_normals_, first_triangle_[posed.mesh], normals_of(mesh));
  }
  if (!pose.materials.empty()) rewrite.add(materials_, 0, material_data(*moving_));
  rewrite.run(device_);
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
  frame_ =
      frame_data(camera, previous, view.width, view.height, view.reversed_z, uint32_t(scene_->lights.size()),
                 frame_index, camera.span ? depth_end(*scene_, camera) : 0.0);
  std::memcpy(frame_buffer_.bytes().data(), &frame_, sizeof(frame_));
  if (eye_moved || any_light()) {  // positions are relative to the eye
    write(lights_, light_data(*scene_, eye));
  }
  if (eye_moved || casters_changed_) write(instances_, instance_data(*scene_, first_triangle_, eye));
  camera_ = camera;
  view_ = view;
}

}  // namespace gnomon
