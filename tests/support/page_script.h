// What stands in a page.
#pragma once

#include <string>

namespace etendue::test {

/// The text of the script element of `page` with this id and a type.
inline std::string page_script(const std::string& page, const std::string& id) {
    const std::size_t begin = page.find('>', page.find("id=\"" + id + "\" type")) + 1;
    return page.substr(begin, page.find("</script>", begin) - begin);
}

}  // namespace etendue::test
