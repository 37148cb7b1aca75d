// SPDX-License-Identifier: GPL-3.0-or-later
// Empty: the target it belongs to exists for its precompiled header.
