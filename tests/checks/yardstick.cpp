// SPDX-License-Identifier: MIT
// What the time of other programs is measured by where one is compiled: one of Eigen's decompositions, optimised and
// generated, and nothing of the toolkit. It is not to be changed: figures of compile_time.sh are multiples of it.
#include <Eigen/LU>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

double solved(const Eigen::Matrix4d& matrix) {
    const Eigen::Vector4d ones = Eigen::Vector4d::Ones();
    return matrix.fullPivLu().solve(ones).norm() + (matrix * ones - matrix.transpose() * ones).norm();
}

int main(int count, char** words) {
    std::map<std::string, std::vector<double>> values;
    for (int k = 0; k < count; ++k) values[words[k]].push_back(static_cast<double>(k));
    double sum = 0.0;
    for (auto& [word, list] : values) {
        std::sort(list.begin(), list.end());
        sum += solved(Eigen::Matrix4d::Identity() * list.front());
    }
    return sum > 0.0 ? 0 : 1;
}
