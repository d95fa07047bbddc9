"""A small disk in memory for the data of a database, which the test can fill."""
import ctypes
import os
import pathlib
import subprocess
import tempfile

SIZE_MIB = 384
NEW_MOUNTS = 0x00020000  # CLONE_NEWNS


def can_mount():
    """Returns true if this process may mount small disks. Call it before threads are started.

    The process then has mounts of its own. The kernel removes them with its last process, however it ends.
    """
    if os.geteuid() != 0 or ctypes.CDLL(None).unshare(NEW_MOUNTS) != 0:
        return False
    try:
        # Otherwise the mounts would show outside.
        subprocess.run(["mount", "--make-rprivate", "/"], check=True, stderr=subprocess.DEVNULL)
        with tempfile.TemporaryDirectory() as folder:
            SmallDisk(pathlib.Path(folder)).unmount()
    except subprocess.CalledProcessError:
        return False
    return True


class SmallDisk:
    def __init__(self, folder):
        """Mounts it at a folder. Fails with CalledProcessError if that is not permitted."""
        self.folder = folder
        self.ballast = folder / "ballast"
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE_MIB}m", "tmpfs", folder], check=True,
                       stderr=subprocess.DEVNULL)

    def fill(self):
        """Leaves no room."""
        with open(self.ballast, "wb", buffering=0) as ballast:
            for size in (2**20, 4096):
                try:
                    while ballast.write(bytes(size)) > 0:
                        pass
                except OSError:
                    pass

    def clear(self):
        """Gives the room back."""
        self.ballast.unlink(missing_ok=True)

    def used_mib(self):
        room = os.statvfs(self.folder)
        return (room.f_blocks - room.f_bfree) * room.f_frsize // 2**20

    def unmount(self):
        subprocess.run(["umount", "--lazy", self.folder], check=True)
