#include "hdf/hdf5_child.h"

#include <fmt/format.h>

#include <stdexcept>

#include "hdf/hdf5_library.h"

namespace echocine {

namespace {

// The reason why the child does not read a value.
class Hdf5Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Hdf5Reader {
 public:
  Hdf5Reader(const std::filesystem::path& file, const ChildWriter& write)
      : write_(write), file_(opened(file), H5Fclose) {}

  void answer(const Hdf5Query& query) const {
    if (query.attribute) return answerAttribute(query);
    if (!isThere(query.name)) return put(Hdf5Sign::absent);
    const Hdf5Handle set(kept(H5Dopen2(file_, query.name.c_str(), H5P_DEFAULT)), H5Dclose);
    refuseOutside(set);
    const Hdf5Handle space(kept(H5Dget_space(set)), H5Sclose),
        type(kept(H5Dget_type(set)), H5Tclose);
    if (H5Tget_class(type) == H5T_STRING)
      return putText(query, textOf(type, space, query, [&](hid_t memory, void* to) {
                       return H5Dread(set, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
                     }));
    putNumbers(set, space, type, query);
  }

 private:
  static hid_t opened(const std::filesystem::path& file) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print
    H5PLset_loading_state(0);                     // no code from outside
    const hid_t id = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (id < 0) throw Hdf5Refusal("is damaged, or no HDF5 file");
    return id;
  }

  static hid_t kept(hid_t id) {
    if (id < 0) throw Hdf5Refusal("is damaged");
    return id;
  }

  // Group by group: hard links only, so that no link leads out of the file.
  bool isThere(const std::string& name) const {
    for (std::size_t end = name.find('/');; end = name.find('/', end + 1)) {
      const std::string part = name.substr(0, end);
      const htri_t exists = H5Lexists(file_, part.c_str(), H5P_DEFAULT);
      if (exists <= 0) return false;
      H5L_info_t link;
      if (H5Lget_info(file_, part.c_str(), &link, H5P_DEFAULT) < 0) throw Hdf5Refusal("is damaged");
      if (link.type != H5L_TYPE_HARD) throw Hdf5Refusal(fmt::format("{}: is a link", part));
      if (end == std::string::npos) return true;
    }
  }

  static void refuseOutside(hid_t set) {
    const Hdf5Handle properties(kept(H5Dget_create_plist(set)), H5Pclose);
    if (H5Pget_layout(properties) == H5D_VIRTUAL || H5Pget_external_count(properties) != 0)
      throw Hdf5Refusal("its values lie in another file");
    const int filters = H5Pget_nfilters(properties);
    for (int i = 0; i < filters; ++i) {
      unsigned flags = 0, config = 0;
      std::size_t values = 0;
      char name[64] = {};
      const H5Z_filter_t id = H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &values,
                                             nullptr, sizeof name, name, &config);
      if (id < 0 || H5Zfilter_avail(id) <= 0)
        throw Hdf5Refusal(
            fmt::format("is compressed by filter {} ({}), accepted: gzip and those of the HDF5 "
                        "library",
                        static_cast<int>(id), *name != 0 ? name : "without a name"));
    }
  }

  // Values of a space, checked before memory is taken.
  static std::vector<hsize_t> shapeOf(hid_t space, const Hdf5Query& query) {
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0 || static_cast<std::size_t>(rank) > kMostHdf5Rank || H5Sis_simple(space) <= 0)
      throw Hdf5Refusal("has no plain shape");
    std::vector<hsize_t> shape(static_cast<std::size_t>(rank));
    if (rank > 0 && H5Sget_simple_extent_dims(space, shape.data(), nullptr) != rank)
      throw Hdf5Refusal("is damaged");
    hsize_t count = 1;
    for (const hsize_t side : shape) {
      if (side == 0) throw Hdf5Refusal("is empty");
      if (side > query.most_values / count)
        throw Hdf5Refusal(fmt::format("has too many values, accepted: {}", query.most_values));
      count *= side;
    }
    if (H5Sget_simple_extent_type(space) == H5S_NULL) throw Hdf5Refusal("is empty");
    return shape;
  }

  template <typename Read>
  static std::string textOf(hid_t type, hid_t space, const Hdf5Query& query, const Read& read) {
    if (!shapeOf(space, {query.name, 1}).empty()) throw Hdf5Refusal("is a list of texts");
    const Hdf5Handle memory(kept(H5Tcopy(type)), H5Tclose);
    if (H5Tis_variable_str(type) > 0) {
      char* text = nullptr;
      if (read(memory, static_cast<void*>(&text)) < 0) throw Hdf5Refusal("is damaged");
      return text == nullptr ? "" : text;  // the process ends soon
    }
    const std::size_t size = H5Tget_size(type);
    if (size > query.most_values) throw Hdf5Refusal("is too long a text");
    std::string text(size, '\0');
    if (read(memory, static_cast<void*>(text.data())) < 0) throw Hdf5Refusal("is damaged");
    return text.c_str();
  }

  void answerAttribute(const Hdf5Query& query) const {
    if (H5Aexists(file_, query.name.c_str()) <= 0) return put(Hdf5Sign::absent);
    const Hdf5Handle made(kept(H5Aopen(file_, query.name.c_str(), H5P_DEFAULT)), H5Aclose);
    const Hdf5Handle space(kept(H5Aget_space(made)), H5Sclose),
        type(kept(H5Aget_type(made)), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING) throw Hdf5Refusal("is no text");
    putText(query, textOf(type, space, query,
                          [&](hid_t memory, void* to) { return H5Aread(made, memory, to); }));
  }

  void putText(const Hdf5Query& query, const std::string& text) const {
    if (text.size() > query.most_values) throw Hdf5Refusal("is too long a text");
    put(Hdf5Sign::text);
    putPlain(text);
  }

  void putNumbers(hid_t set, hid_t space, hid_t type, const Hdf5Query& query) const {
    const H5T_class_t kind = H5Tget_class(type);
    if (kind != H5T_INTEGER && kind != H5T_FLOAT) throw Hdf5Refusal("holds no numbers");
    const std::vector<hsize_t> shape = shapeOf(space, query);
    std::size_t count = 1;
    for (const hsize_t side : shape) count *= static_cast<std::size_t>(side);
    const bool bytes =
        kind == H5T_INTEGER && H5Tget_size(type) == 1 && H5Tget_sign(type) == H5T_SGN_NONE;
    std::vector<char> values(count * (bytes ? 1 : sizeof(float)));
    if (H5Dread(set, bytes ? H5T_NATIVE_UINT8 : H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                values.data()) < 0)
      throw Hdf5Refusal("its values cannot be read: the file is damaged or cut off");
    put(bytes ? Hdf5Sign::bytes : Hdf5Sign::floats);
    putNumber(shape.size());
    for (const hsize_t side : shape) putNumber(static_cast<std::size_t>(side));
    write_(std::as_bytes(std::span(values)));
  }

  void put(Hdf5Sign sign) const { write_(std::as_bytes(std::span(&sign, 1))); }
  void putNumber(std::size_t number) const { write_(std::as_bytes(std::span(&number, 1))); }
  void putPlain(const std::string& text) const {
    putNumber(text.size());
    write_(std::as_bytes(std::span(text)));
  }

  const ChildWriter& write_;
  Hdf5Handle file_;
};

}  // namespace

void answerHdf5(const std::filesystem::path& file, std::span<const Hdf5Query> queries,
                const ChildWriter& write) {
  std::string asked;
  try {
    const Hdf5Reader reader(file, write);
    for (const Hdf5Query& query : queries) {
      asked = query.name + ": ";
      reader.answer(query);
    }
  } catch (const Hdf5Refusal& refusal) {
    const std::string reason = (asked + refusal.what()).substr(0, kMostHdf5Reason);
    const Hdf5Sign sign = Hdf5Sign::refused;
    const std::size_t size = reason.size();
    write(std::as_bytes(std::span(&sign, 1)));
    write(std::as_bytes(std::span(&size, 1)));
    write(std::as_bytes(std::span(reason)));
  }
}

}  // namespace echocine
