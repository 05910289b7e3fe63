#pragma once

#include <string>
#include <vector>

namespace geo::io {

// The libraries that read NetCDF and GeoTIFF do not survive every damaged file: some end the
// program, some never come back. A program that must not go down with a file lets another process
// read it and takes the values over from there. Without that the library reads every file itself.

/// From now on files are read by processes of their own, each started as `command`, but for those
/// whose bytes are as a manifest beside them says: this program wrote them. Such a process must
/// call answer_reader(). One that ends before its answer, or takes many times as long as a file of
/// its size can need, is an InputError that names the file. Call it before there are threads.
void read_files_aside(std::vector<std::string> command);

/// Reads what the process that started this one asks for and hands it over through a socket.
/// The exit status of the process: 0 when there was an answer, be it a refusal.
int answer_reader();

}  // namespace geo::io
