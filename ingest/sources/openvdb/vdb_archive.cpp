#include "vdb_archive.h"

#include <openvdb/io/DelayedLoadMetadata.h>

#include <algorithm>

namespace nepho::vdb {

using openvdb::GridBase;

namespace {

// Once per process. The metadata of delayed loading are not used here, and their reader allocates
// what they claim: 4 GB from one wrong byte. Unregistered, they are bytes like any unknown kind.
void initialize() {
  static const bool done = [] {
    openvdb::initialize();
    openvdb::io::DelayedLoadMetadata::unregisterType();
    return true;
  }();
  (void)done;
}

}  // namespace

VdbArchive::VdbArchive(const std::string& file)
    : stream_(file, std::ios::binary), tags_(new openvdb::io::StreamMetadata) {
  initialize();
  stream_.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
  tags_->setSeekable(true);
  openvdb::io::setStreamMetadataPtr(stream_, tags_, /*transfer=*/false);
  readHeader(stream_);
  setFormatVersion(stream_);
  setLibraryVersion(stream_);
  setDataCompression(stream_);
  metadata_.readMeta(stream_);
  const std::int32_t count = readGridCount(stream_);
  for (std::int32_t at = 0; at < count; ++at) {
    Entry entry;
    entry.grid = entry.descriptor.read(stream_);
    start(entry);
    entry.descriptor.seekToEnd(stream_);
    entries_.push_back(std::move(entry));
  }
}

// Up to where the tree begins.
GridBase::Ptr VdbArchive::start(const Entry& entry) {
  entry.descriptor.seekToGrid(stream_);
  readGridCompression(stream_);
  openvdb::io::setHalfFloat(stream_, entry.descriptor.saveFloatAsHalf());
  openvdb::io::setGridBackgroundValuePtr(stream_, nullptr);
  entry.grid->clearMetadata();
  entry.grid->readMeta(stream_);
  openvdb::io::setGridClass(stream_, entry.grid->getGridClass());
  entry.grid->readTransform(stream_);
  return entry.grid;
}

// Grids can share one tree, which is then stored with the first of them.
const VdbArchive::Entry& VdbArchive::with_tree(const Entry& entry) const {
  if (!entry.descriptor.isInstance()) return entry;
  const auto parent =
      std::ranges::find(entries_, entry.descriptor.instanceParentName(),
                        [](const Entry& other) { return other.descriptor.uniqueName(); });
  if (parent == entries_.end() || parent->descriptor.isInstance())
    OPENVDB_THROW(openvdb::IoError, "a grid shares a tree that is not in the file");
  return *parent;
}

GridBase::Ptr VdbArchive::topology(const Entry& entry) {
  const GridBase::Ptr grid = start(with_tree(entry));
  grid->readTopology(stream_);
  return grid;
}

GridBase::Ptr VdbArchive::whole(const Entry& entry) {
  const Entry& owner = with_tree(entry);
  owner.descriptor.seekToGrid(stream_);
  owner.grid->clearMetadata();
  readGrid(owner.grid, owner.descriptor, stream_);
  return owner.grid;
}

}  // namespace nepho::vdb
