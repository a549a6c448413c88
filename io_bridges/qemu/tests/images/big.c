/* Does not fit into 1 MiB of flash. */
static const unsigned char filler[1200 * 1024] = {1};
int main(void) {
  return ((volatile const unsigned char*)filler)[1];
}
