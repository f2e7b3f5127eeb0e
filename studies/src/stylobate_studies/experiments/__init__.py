"""Against nature: open measurements that lie beside the project, computed again and scored."""
