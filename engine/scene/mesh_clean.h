// Repairs and facts of a triangle mesh: what a scene promises about its meshes is made true here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace gnomon {

struct DroppedTriangles {
  uint64_t degenerate = 0, nonfinite = 0;
};

// Drops triangles that have a NaN or infinite vertex, and those without area: a vertex used twice, or a
// height below 1e-10 of the longest edge, which float positions reach only when the three points are
// collinear to rounding. Then drops vertices that no triangle uses.
DroppedTriangles drop_bad_triangles(Mesh& mesh);
// The same for a mesh whose shape changes: of those without area only the ones that never have any go, which
// use a vertex twice. `origins`: where each vertex was before, as make_flat_normals() too keeps it.
DroppedTriangles drop_bad_triangles(Mesh& mesh, std::vector<uint32_t>& origins);

// Normals of the faces; vertices are split so that every triangle has its own three (glTF 2.0, 3.7.2.1: flat
// normals when a file has none).
void make_flat_normals(Mesh& mesh);
void make_flat_normals(Mesh& mesh, std::vector<uint32_t>& origins);

// Unit length; a normal that is zero or not finite becomes the area-weighted mean of its vertex's faces.
void repair_normals(Mesh& mesh);

// Bounds and watertightness. Call last.
void finish_mesh(Mesh& mesh);

// True when, after welding vertices of exactly equal position, every edge belongs to exactly two triangles
// that run along it in opposite directions.
bool is_watertight(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices);

// Vertices whose position, normal, coordinate and colour all equal an earlier vertex's.
uint64_t count_duplicate_vertices(const Mesh& mesh);

// All vertices lie in one plane, within 1e-6 of the mesh's size. `normal`: unit, object space.
bool is_planar(const Mesh& mesh, glm::dvec3& point, glm::dvec3& normal);

// Does a ray from the point cross the mesh an odd number of times? Then it is inside, if the mesh is
// watertight.
bool is_inside(const Mesh& mesh, const glm::dvec3& point);

// The same shape with object space mirrored in x, and triangles turned so that counter-clockwise stays the
// front.
Mesh mirrored(const Mesh& mesh);

}  // namespace gnomon
