#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/quality/indexed_mesh.hpp>
#include <gridmorph/quality/unstructured_quality.hpp>
#include <gridmorph/quality/validity.hpp>

#include <mutex>
#include <utility>

namespace gridmorph {

struct IndexedMesh::State {
  HostInstance host;
  Mesh mesh;
  bool structured;
  UnstructuredTopology topology;
  BoundaryFacePatches face_patches;
  mutable std::once_flag oriented;
  mutable std::vector<int> handedness;
  mutable std::vector<signed char> signs;

  State(HostInstance const& on, Mesh&& of) : host(on), mesh(std::move(of)), structured(mesh.is_structured()) {
    if (structured) return;
    check_mesh(mesh);
    topology = make_topology(host, mesh);
    face_patches = find_face_patches(mesh, topology);
  }

  void orient() const {
    std::call_once(oriented, [this] {
      if (structured)
        handedness = host.visit([&](auto const& exec) { return zone_handedness(exec, mesh, views(mesh.coordinates)); });
      else
        signs = numbering_signs(host, mesh, topology.sides);
    });
  }
};

IndexedMesh::IndexedMesh(HostInstance const& host, Mesh mesh)
    : state_(std::make_shared<State>(host, std::move(mesh))) {}

Mesh const& IndexedMesh::mesh() const { return state_->mesh; }
Mesh IndexedMesh::take_mesh() && {
  std::shared_ptr<State> const state = std::move(state_);
  return state.use_count() == 1 ? std::move(state->mesh) : state->mesh;
}
bool IndexedMesh::is_structured() const { return state_->structured; }
Index IndexedMesh::n_cells() const { return is_structured() ? mesh().n_cells() : mesh().n_elements(); }
UnstructuredTopology const& IndexedMesh::topology() const { return state_->topology; }
BoundaryFacePatches const& IndexedMesh::face_patches() const { return state_->face_patches; }

std::vector<int> const& IndexedMesh::handedness() const {
  state_->orient();
  return state_->handedness;
}

std::vector<signed char> const& IndexedMesh::signs() const {
  state_->orient();
  return state_->signs;
}

Boundary IndexedMesh::boundary() const {
  return is_structured() ? Boundary(mesh()) : Boundary(mesh(), topology(), face_patches());
}

Certificate certify(IndexedMesh const& mesh, Coordinates const& morphed, std::vector<int> zones) {
  CertificateInput<Kokkos::HostSpace> input{views(morphed), views(mesh.mesh().coordinates)};
  input.zones = std::move(zones);
  Kokkos::DefaultHostExecutionSpace const exec;
  if (mesh.is_structured()) {
    input.handedness = mesh.handedness();
    return certify(exec, mesh.mesh(), input);
  }
  input.signs = mesh.signs();
  return certify(exec, mesh.mesh(), mesh.topology(), input);
}

}  // namespace gridmorph
