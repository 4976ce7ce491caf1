#pragma once

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <fstream>
#include <string>
#include <vector>

namespace nepho::vdb {

// One file through OpenVDB's own grid readers, but on a stream that throws at its end:
// openvdb::io::File reads on there, and a damaged count then keeps it busy for minutes. Reads one
// grid at a time, and its topology without its values where that is enough.
class VdbArchive : private openvdb::io::Archive {
 public:
  struct Entry {
    openvdb::io::GridDescriptor descriptor;
    openvdb::GridBase::Ptr grid;  // metadata and transform; no tree
  };

  // Reads what is said of the grids. The container has been checked.
  explicit VdbArchive(const std::string& file);

  const std::vector<Entry>& entries() const { return entries_; }
  const openvdb::MetaMap& metadata() const { return metadata_; }
  // The grid's tree with inactive buffers: fit for active boxes only.
  openvdb::GridBase::Ptr topology(const Entry& entry);
  openvdb::GridBase::Ptr whole(const Entry& entry);

 private:
  openvdb::GridBase::Ptr start(const Entry& entry);
  const Entry& with_tree(const Entry& entry) const;

  std::ifstream stream_;
  openvdb::io::StreamMetadata::Ptr tags_;
  openvdb::MetaMap metadata_;
  std::vector<Entry> entries_;
};

}  // namespace nepho::vdb
